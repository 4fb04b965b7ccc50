// Steps of a number from 0 to 1.
const ANTUMBRA_BOX_STEPS: f32 = 65535.0;

// Which texels a box begins and ends in, along one axis, and what it covers of the first, of those in between, and of
// the last.
struct AntumbraEdges {
    nodes: vec4i,
    weights: vec3f,
    whole: f32,
}

// Of a box in a tile of so many texels. Towards the rim it narrows: what is not drawn is not known.
fn antumbra_edges(place: f32, radius: f32, side: f32) -> AntumbraEdges {
    let at = min(max(place, 0.5), side - 0.5);
    let room = min(at, side - at) - 1.5;
    let half_width = max(min(radius, room), 0.5);
    let low = at - half_width;
    let high = at + half_width;
    let first = floor(low);
    let last = max(floor(high), first + 1.0);
    let weights = vec3f(first + 1.0 - low, 1.0, max(high - last, 0.0));
    let nodes = vec4i(vec4f(first, first + 1.0, last, min(last + 1.0, side)));
    return AntumbraEdges(nodes, weights, weights.x + (last - first - 1.0) + weights.z);
}

// Sums of all rows before y, between four columns. Sums wrap around, and so do their differences, to what they are.
struct AntumbraSums {
    first: vec4u,
    inner: vec4u,
    last: vec4u,
}

fn antumbra_sums_of_row(map: texture_2d<u32>, look: AntumbraLookup, corner: vec2i, columns: vec4i, y: i32) -> AntumbraSums {
    let a = antumbra_sum_before(map, look, corner, vec2i(columns.x, y));
    let b = antumbra_sum_before(map, look, corner, vec2i(columns.y, y));
    let c = antumbra_sum_before(map, look, corner, vec2i(columns.z, y));
    let d = antumbra_sum_before(map, look, corner, vec2i(columns.w, y));
    return AntumbraSums(b - a, c - b, d - c);
}

// What lies between two rows, weighted column by column.
fn antumbra_strip(above: AntumbraSums, below: AntumbraSums, weights: vec3f) -> vec4f {
    return vec4f(below.first - above.first) * weights.x
        + vec4f(below.inner - above.inner) * weights.y
        + vec4f(below.last - above.last) * weights.z;
}

// The mean of what is stored around the place that is looked up, over the receiver's box.
fn antumbra_stored_at(map: texture_2d<u32>, linear: sampler, look: AntumbraLookup) -> vec4f {
    let size = vec2f(textureDimensions(map));
    let first = floor(look.low * size);
    let corner = vec2i(first);
    let side = floor(look.high * size) - first + 1.0;
    let place = look.uv * size - first;
    let u = antumbra_edges(place.x, look.radius.x, side.x);
    let v = antumbra_edges(place.y, look.radius.y, side.y);
    let one = antumbra_sums_of_row(map, look, corner, u.nodes, v.nodes.x);
    let two = antumbra_sums_of_row(map, look, corner, u.nodes, v.nodes.y);
    let three = antumbra_sums_of_row(map, look, corner, u.nodes, v.nodes.z);
    let four = antumbra_sums_of_row(map, look, corner, u.nodes, v.nodes.w);
    let sum = antumbra_strip(one, two, u.weights) * v.weights.x
        + antumbra_strip(two, three, u.weights) * v.weights.y
        + antumbra_strip(three, four, u.weights) * v.weights.z;
    return sum / (u.whole * v.whole * ANTUMBRA_BOX_STEPS);
}
