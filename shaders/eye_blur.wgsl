// What the blur of a picture has to know of its camera. The layout is `EyeBlurUniforms`.
struct AntumbraEyeBlur {
    // Eye depth of a value of the depth buffer: (x d + y) / (z d + w).
    eye_depth: vec4f,
    // w of clip space at an eye depth: x times it, and y. Pixels for a deviation of the bell where w is 1: z along a
    // row of the picture, w along a column.
    pixels: vec4f,
    // Largest deviation, pixels; eye depth between two pixels from which on they are not of one surface, world units.
    most: f32,
    edge: f32,
    padding: vec2f,
}

// Beyond every eye depth there is: where nothing was drawn.
const ANTUMBRA_EYE_BLUR_FARTHEST: f32 = 1e30;

// Below every divisor of an eye depth.
const ANTUMBRA_EYE_BLUR_SMALLEST: f32 = 1e-30;

// Deviations at which a bell ends: 1 would be a box with soft corners, more costs taps that weigh less than 4 %.
const ANTUMBRA_EYE_BLUR_REACH: f32 = 2.5;

// By how much less a bell deviates that ends there: 1 / 0.9546.
const ANTUMBRA_EYE_BLUR_CUT: f32 = 1.0476;

// Eye depth of a value of the depth buffer, world units.
fn antumbra_eye_depth(blur: AntumbraEyeBlur, depth: f32) -> f32 {
    let divisor = blur.eye_depth.z * depth + blur.eye_depth.w;
    if (abs(divisor) < ANTUMBRA_EYE_BLUR_SMALLEST) {
        return ANTUMBRA_EYE_BLUR_FARTHEST;
    }
    return min((blur.eye_depth.x * depth + blur.eye_depth.y) / divisor, ANTUMBRA_EYE_BLUR_FARTHEST);
}

// Deviation of the bell at an eye depth, pixels along a row and along a column: a world width, up to the largest.
fn antumbra_eye_blur_deviation(blur: AntumbraEyeBlur, eye_depth: f32) -> vec2f {
    let w = max(blur.pixels.x * eye_depth + blur.pixels.y, ANTUMBRA_EYE_BLUR_SMALLEST);
    return min(blur.pixels.zw / w, vec2f(blur.most));
}

// How many pixels to either side weigh anything.
fn antumbra_eye_blur_reach(deviation: f32) -> i32 {
    return i32(ceil(deviation * ANTUMBRA_EYE_BLUR_CUT * ANTUMBRA_EYE_BLUR_REACH - 0.5));
}

// Weight of a pixel at an offset: the height of the bell there, and its overlap with what the bell reaches, so that
// pixels come and go by parts as it narrows with depth. None across an edge of depth.
// apart: eye depth from the pixel in the middle, world units.
fn antumbra_eye_blur_weight(blur: AntumbraEyeBlur, offset: f32, deviation: f32, apart: f32) -> f32 {
    let wide = deviation * ANTUMBRA_EYE_BLUR_CUT;
    let share = offset / max(wide, ANTUMBRA_EYE_BLUR_SMALLEST);
    let overlap = clamp(wide * ANTUMBRA_EYE_BLUR_REACH + 0.5 - abs(offset), 0.0, 1.0);
    return select(0.0, exp(-0.5 * share * share) * overlap, abs(apart) <= blur.edge);
}
