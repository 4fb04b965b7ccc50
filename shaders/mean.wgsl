// A weighted mean in the making.
struct AntumbraMean {
    sum: vec4f,
    whole: f32,
}

fn antumbra_mean_with(mean: AntumbraMean, value: vec4f, weight: f32) -> AntumbraMean {
    return AntumbraMean(mean.sum + value * weight, mean.whole + weight);
}

fn antumbra_mean(mean: AntumbraMean) -> vec4f {
    return mean.sum / max(mean.whole, ANTUMBRA_MEAN_SMALLEST);
}

// Below every sum of weights.
const ANTUMBRA_MEAN_SMALLEST: f32 = 1e-30;
