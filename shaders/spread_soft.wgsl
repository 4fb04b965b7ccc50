// How taps are spread around a receiver: over a disc across the light, which a map may show as an ellipse.
struct AntumbraSpread {
    // By how much of a whole turn the disc is turned.
    noise: f32,
    // Linear light depth of the receiver, and w there.
    depth: f32,
    w: f32,
    // Texels along two radii of the penumbra, for each unit of linear light depth between caster and receiver.
    along: vec2f,
    across: vec2f,
    // By how much of itself one over w falls along them.
    fade: vec2f,
    // Least and greatest distance between caster and receiver whose penumbra the map shows as wide as it is.
    least: f32,
    most: f32,
    // How a lookup's texture coordinates and depth go back for each texel that a disc is narrower than the widest one.
    back: vec3f,
}

// Below every length that is divided by.
const ANTUMBRA_SPREAD_SMALLEST: f32 = 1e-30;

// Below every w in view.
const ANTUMBRA_SPREAD_LEAST_W: f32 = 1e-6;

// Radius of the narrowest disc, texels: at 0 edges at contacts would be as soft as one tap, at 1 softer than they need
// be.
const ANTUMBRA_NARROWEST: f32 = 0.5;

fn antumbra_spread(view: AntumbraView, position: vec3f, noise: f32) -> AntumbraSpread {
    let at = vec4f(position, 1.0);
    let w = max(dot(view.w_from_render, at), ANTUMBRA_SPREAD_LEAST_W);
    let uv = vec2f(dot(view.u_from_render, at), dot(view.v_from_render, at)) / w;
    // How texture coordinates change with the position: across the light alone.
    let along_u = (view.u_from_render.xyz - uv.x * view.w_from_render.xyz) / w;
    let along_v = (view.v_from_render.xyz - uv.y * view.w_from_render.xyz) / w;
    // Two directions across the light, along the first of which v may change, but along the second u does not.
    let travel = view.depth_from_render.xyz / max(length(view.depth_from_render.xyz), ANTUMBRA_SPREAD_SMALLEST);
    let first = along_u / max(length(along_u), ANTUMBRA_SPREAD_SMALLEST);
    let second = cross(travel, first);
    // Radii of the penumbra.
    let texels = view.moments.x / max(view.bias.w, ANTUMBRA_SPREAD_SMALLEST);
    var spread: AntumbraSpread;
    spread.noise = noise;
    spread.depth = dot(view.depth_from_render, at);
    spread.w = w;
    spread.along = vec2f(dot(along_u, first), dot(along_v, first)) * texels;
    spread.across = vec2f(0.0, dot(along_v, second)) * texels;
    spread.fade = vec2f(dot(view.w_from_render.xyz, first), dot(view.w_from_render.xyz, second)) * (view.moments.x / w);
    let wide = max(abs(spread.along.x), length(vec2f(spread.along.y, spread.across.y)));
    spread.least = ANTUMBRA_NARROWEST / max(wide, ANTUMBRA_SPREAD_SMALLEST);
    spread.most = max(view.moments.y, ANTUMBRA_NARROWEST) / max(wide, ANTUMBRA_SPREAD_SMALLEST);
    return spread;
}
