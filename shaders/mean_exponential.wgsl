// A weighted mean of exponentials in the making: the sum of their parts, and the farthest depth so far.
struct AntumbraMean {
    sum: vec4f,
    whole: f32,
}

fn antumbra_mean_with(mean: AntumbraMean, value: vec4f, weight: f32) -> AntumbraMean {
    let farthest = select(max(mean.sum.y, value.x), value.x, mean.whole == 0.0);
    let before = mean.sum.x * antumbra_exponential_part(mean.sum.y, farthest, ANTUMBRA_EXPONENT);
    let part = weight * antumbra_exponential_part(value.x, farthest, ANTUMBRA_EXPONENT);
    return AntumbraMean(vec4f(before + part, farthest, 0.0, 0.0), mean.whole + weight);
}

fn antumbra_mean(mean: AntumbraMean) -> vec4f {
    let sum = mean.sum.x / max(mean.whole, ANTUMBRA_MEAN_SMALLEST);
    return vec4f(antumbra_exponential_mean(sum, mean.sum.y, ANTUMBRA_EXPONENT), 0.0, 0.0, 0.0);
}

// Below every sum of weights.
const ANTUMBRA_MEAN_SMALLEST: f32 = 1e-30;
