// Below every square of a length that is divided by.
const ANTUMBRA_PIXEL_SMALLEST: f32 = 1e-30;

// Sine of the angle between normal and line of sight, squared, below which every direction in the surface is as good.
const ANTUMBRA_HEAD_ON: f32 = 1e-8;

// Cosine of that angle below which pixels are taken to be no longer on the surface: 20 times as long as wide.
const ANTUMBRA_LEAST_FACING: f32 = 0.05;

// The pixel that shows a receiver, laid on its plane.
struct AntumbraPixel {
    // From the receiver to two of four places, world units. The others lie opposite.
    first: vec3f,
    second: vec3f,
    // How far they are.
    distance: vec2f,
}

// The same by every view of a frame.
fn antumbra_pixel(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraPixel {
    // From the eye, or along the view where that is parallel.
    let from_eye = position * view.moments.w - view.moments.xyz;
    let sight = from_eye * inverseSqrt(max(dot(from_eye, from_eye), ANTUMBRA_PIXEL_SMALLEST));
    // An eighth of a pixel on the receiver's plane: as wide as it is across the line of sight, and longer at a slant.
    let size = 0.125 * dot(view.pixel_from_render, vec4f(position, 1.0));
    let longer = 1.0 / max(abs(dot(sight, normal)), ANTUMBRA_LEAST_FACING);
    let level = cross(sight, normal);
    let any = select(vec3f(0.0, normal.z, -normal.y), vec3f(-normal.z, 0.0, normal.x), abs(normal.x) > 0.7);
    let across = select(any, level, dot(level, level) > ANTUMBRA_HEAD_ON);
    let wide = across * (size * inverseSqrt(max(dot(across, across), ANTUMBRA_PIXEL_SMALLEST)));
    let long = cross(normal, wide) * longer;
    // Four places out of sixteen, of which no two share a row or a column.
    let stretched = longer * longer;
    let distance = sqrt(dot(wide, wide) * vec2f(9.0 + stretched, 1.0 + 9.0 * stretched));
    return AntumbraPixel(3.0 * wide + long, 3.0 * long - wide, distance);
}
