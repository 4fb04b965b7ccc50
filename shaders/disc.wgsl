// Points of a disc by Vogel's spiral (1979): each a golden angle further round than the one before, and as far out as
// makes all of them stand for the same area.

// A whole turn, radians.
const ANTUMBRA_TURN: f32 = 6.2831855;

// Cosine and sine of the golden angle, pi (3 - sqrt 5).
const ANTUMBRA_GOLDEN = vec2f(-0.73736888, 0.67549029);

// The direction of the first point of a disc that is turned by a share of a whole turn: any number is one.
fn antumbra_turned(noise: f32) -> vec2f {
    let angle = (noise - floor(noise + 0.5)) * ANTUMBRA_TURN;
    return vec2f(cos(angle), sin(angle));
}

// The direction of the point after one.
fn antumbra_next(direction: vec2f) -> vec2f {
    return vec2f(
        direction.x * ANTUMBRA_GOLDEN.x - direction.y * ANTUMBRA_GOLDEN.y,
        direction.x * ANTUMBRA_GOLDEN.y + direction.y * ANTUMBRA_GOLDEN.x,
    );
}

// How far out a point is, 0 to 1.
fn antumbra_out(point: u32, points: u32) -> f32 {
    return sqrt((f32(point) + 0.5) / f32(points));
}
