//! Statistics of measurements: quantiles, geometric means, rank correlation, Pareto fronts. NaN where there is nothing to go by.

/// The mean of numbers.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The geometric mean of positive numbers.
#[must_use]
pub fn geometric_mean(values: &[f64]) -> f64 {
    (values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64).exp()
}

/// The value below which a `share` (0 to 1) of the numbers lies, interpolated between neighbours.
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share.clamp(0.0, 1.0) * last as f64;
    let (below, part) = (at as usize, at.fract());
    let above = (below + 1).min(last);
    sorted[below] + part * (sorted[above] - sorted[below])
}

/// Spearman's rank correlation of pairs, −1 to 1; ties share their mean rank. NaN where either side is constant.
///
/// C. Spearman, *The proof and measurement of association between two things*, 1904.
#[must_use]
pub fn rank_correlation(pairs: &[[f64; 2]]) -> f64 {
    let [a, b] = [0, 1].map(|side| ranks(&pairs.iter().map(|pair| pair[side]).collect::<Vec<_>>()));
    let (mean_a, mean_b) = (mean(&a), mean(&b));
    let product = |x: &[f64], mean_x: f64, y: &[f64], mean_y: f64| -> f64 {
        x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum()
    };
    product(&a, mean_a, &b, mean_b) / (product(&a, mean_a, &a, mean_a) * product(&b, mean_b, &b, mean_b)).sqrt()
}

/// Which points [x, y] no other one beats: none is as small in both and smaller in one. NaN is never among them.
#[must_use]
pub fn pareto_front(points: &[[f64; 2]]) -> Vec<bool> {
    let figures = |point: &[f64; 2]| !point.iter().any(|value| value.is_nan());
    let beats = |other: &[f64; 2], point: &[f64; 2]| {
        figures(other) && other[0] <= point[0] && other[1] <= point[1] && other != point
    };
    points.iter().map(|point| figures(point) && !points.iter().any(|other| beats(other, point))).collect()
}

/// The rank of every value; equal ones share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let rank = |value: &f64| {
        let below = values.iter().filter(|other| *other < value).count();
        let equal = values.iter().filter(|other| *other == value).count();
        below as f64 + 0.5 * (equal as f64 - 1.0)
    };
    values.iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_quantiles() {
        assert!((geometric_mean(&[1.0, 4.0, 2.0]) - 2.0).abs() < 1e-15);
        assert_eq!(mean(&[1.0, 2.0, 6.0]), 3.0);
        assert_eq!(quantile(&[3.0, 1.0, 2.0, 4.0], 0.5), 2.5);
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 1.0), 3.0);
        assert_eq!(quantile(&[7.0], 0.3), 7.0);
        assert!(quantile(&[], 0.5).is_nan() && mean(&[]).is_nan() && geometric_mean(&[]).is_nan());
    }

    #[test]
    fn nobody_beats_a_front() {
        let points = [[1.0, 5.0], [2.0, 3.0], [2.0, 4.0], [4.0, 3.0], [5.0, 1.0], [f64::NAN, 0.0], [-1.0, 9.0]];
        assert_eq!(pareto_front(&points), [true, true, false, false, true, false, true]);
        // Equal ones do not beat each other.
        assert_eq!(pareto_front(&[[1.0, 1.0], [1.0, 1.0]]), [true, true]);
        assert!(pareto_front(&[]).is_empty());
    }

    #[test]
    fn ranks_agree_or_not() {
        let against = |b: &[f64]| {
            let pairs: Vec<_> = b.iter().enumerate().map(|(a, b)| [a as f64, *b]).collect();
            rank_correlation(&pairs)
        };
        // Any rising curve agrees, any falling one disagrees.
        assert_eq!(against(&[1.0, 10.0, 11.0, 1e9]), 1.0);
        assert_eq!(against(&[9.0, 5.0, 4.0, -1.0]), -1.0);
        // By hand: 1 − 6 Σ d² / (n (n² − 1)) = 1 − 6 · 2 / 60 for one swap of neighbours.
        assert!((against(&[1.0, 3.0, 2.0, 4.0]) - 0.8).abs() < 1e-15);
        // Ties: ranks 0, 1.5, 1.5, 3 against 0 to 3.
        assert!((against(&[1.0, 2.0, 2.0, 4.0]) - 0.9_f64.sqrt()).abs() < 1e-15);
        assert!(against(&[1.0, 1.0, 1.0]).is_nan());
    }
}
