// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 17.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// Texels that are searched for casters, and taps of the penumbra. Fewer show grains in wide penumbras, and miss thin
// casters; cost grows with them.
const ANTUMBRA_SEARCHED: u32 = 16u;
const ANTUMBRA_DISC_TAPS: u32 = 16u;

// By how much w may change on the way to a texel: as far as maps are made.
const ANTUMBRA_LEAST_LEFT: f32 = 0.5;

// Texels from a receiver to a point of the disc whose radius is the penumbra of a caster at a distance.
fn antumbra_soft_offset(spread: AntumbraSpread, point: vec2f, apart: f32) -> vec2f {
    return (spread.along * point.x + spread.across * point.y) * apart;
}

// A lookup whose bias is that of a disc of this radius, texels. That of the widest one, along the normal of surfaces
// that graze the light, would carry them into the shadow of whatever stands beside them.
fn antumbra_settled(look: AntumbraLookup, radius: f32) -> AntumbraLookup {
    let back = look.spread.back * max(ANTUMBRA_REACH - ANTUMBRA_TAP_REACH - radius, 0.0);
    var settled = look;
    settled.uv += back.xy;
    settled.depth += back.z;
    return settled;
}

// How far casters are from the receiver on the average, in linear light depth; -1 where there are none. It looks as far
// as a caster's penumbra could reach that is at the light's end of the map, and no less far than the filter reads.
fn antumbra_caster_distance(map: texture_depth_2d, look: AntumbraLookup, turned: vec2f) -> f32 {
    let size = vec2f(textureDimensions(map));
    let spread = look.spread;
    let farthest = clamp(spread.depth, 3.0 * spread.least, max(spread.most, 3.0 * spread.least));
    var direction = turned;
    var sum = 0.0;
    var casters = 0.0;
    for (var index = 0u; index < ANTUMBRA_SEARCHED; index++) {
        let point = direction * antumbra_out(index, ANTUMBRA_SEARCHED);
        let texel = floor(look.uv * size + antumbra_soft_offset(spread, point, farthest));
        let stored = antumbra_stored_depth(map, look, texel);
        // Against the receiver's own plane at the texel's centre.
        let plane = look.depth + dot(look.slope, texel + 0.5 - look.uv * size);
        if (stored < min(plane, 1.0)) {
            let left = max(1.0 - dot(spread.fade, point) * farthest, ANTUMBRA_LEAST_LEFT);
            sum += max(spread.depth - stored / antumbra_law(spread.w / left), 0.0);
            casters += 1.0;
        }
        direction = antumbra_next(direction);
    }
    return select(-1.0, sum / max(casters, 1.0), casters > 0.0);
}

// Percentage-closer soft shadows (Fernando 2005): the farther away casters are, the wider the disc.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let turned = antumbra_turned(look.spread.noise);
    // Where a surface that grazes the light is taken for a caster of its own, it is a near one: the disc stays narrow.
    let found = antumbra_caster_distance(map, antumbra_settled(look, 0.0), turned);
    if (found < 0.0) {
        return 1.0;
    }
    let apart = clamp(found, look.spread.least, look.spread.most);
    let settled = antumbra_settled(look, ANTUMBRA_NARROWEST * apart / look.spread.least);
    var direction = turned;
    var lit = 0.0;
    for (var index = 0u; index < ANTUMBRA_DISC_TAPS; index++) {
        let point = direction * antumbra_out(index, ANTUMBRA_DISC_TAPS);
        lit += antumbra_tap(map, compare, settled, antumbra_soft_offset(look.spread, point, apart));
        direction = antumbra_next(direction);
    }
    return lit / f32(ANTUMBRA_DISC_TAPS);
}
