//! Searching a strength: one valley, no allocation, a fixed number of steps.
//!
//! # References
//! - Kiefer, *Sequential minimax search for a maximum*, 1953: golden-section search.

/// The golden ratio less one.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Steps: each leaves 62 % of the interval. 18 leave 1/5800 of it, over ln(1 + κλ) from 0 to 7 a thousandth in κλ + 1. Fewer
/// show as steps of the map when the camera moves; more cost time.
const STEPS: u32 = 18;

/// κλ in [0, `limit`] of the least error; 0 where no strength is better than none.
///
/// Exact to a thousandth of 1 + κλ for errors that fall to one valley and rise behind it. 20 evaluations.
pub(crate) fn least(limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    let at = |log: f64| error(log.exp_m1());
    let (mut low, mut high) = (0.0, limit.ln_1p());
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut error_left, mut error_right) = (at(left), at(right));
    for _ in 0..STEPS {
        if error_left <= error_right {
            (high, right, error_right) = (right, left, error_left);
            left = high - GOLDEN * (high - low);
            error_left = at(left);
        } else {
            (low, left, error_left) = (left, right, error_right);
            right = low + GOLDEN * (high - low);
            error_right = at(right);
        }
    }
    let best = low.midpoint(high);
    if at(best) < error(0.0) { best.exp_m1() } else { 0.0 }
}

/// Halvings in [`not_worse`]: 1/4096 of the interval.
const HALVINGS: u32 = 12;

/// The strength itself where `error` is at most `uniform`; else the largest below it where that holds, or 0.
///
/// Continuous where `uniform` is `error(0.0)` and that has one valley: the largest such strength goes to 0 as the valley does.
pub(crate) fn not_worse(strength: f64, uniform: f64, error: impl Fn(f64) -> f64) -> f64 {
    if !(error(strength) > uniform) {
        return strength;
    }
    let (mut low, mut high) = (0.0, strength.ln_1p());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if error(middle.exp_m1()) > uniform { high = middle } else { low = middle }
    }
    low.exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_valley_is_found() {
        for bottom in [0.0, 1e-3, 0.7, 12.0, 900.0] {
            let found = least(1e3, |s| (s.ln_1p() - f64::ln_1p(bottom)).powi(2));
            assert!((found - bottom).abs() <= 2e-3 * (1.0 + bottom), "{found} {bottom}");
        }
        assert_eq!(least(1e3, |s| s), 0.0);
        assert_eq!(least(0.0, |s| -s), 0.0);
        assert!(least(1e3, |_| f64::NAN) == 0.0);
    }

    #[test]
    fn guarded_strengths_are_not_worse() {
        // A valley at 2, back at the level of none at 1 + s = 9.
        let error = |s: f64| (s.ln_1p() - f64::ln(3.0)).powi(2);
        assert_eq!(not_worse(5.0, error(0.0), error), 5.0);
        let limited = not_worse(100.0, error(0.0), error);
        assert!((limited - 8.0).abs() < 0.02 && error(limited) <= error(0.0), "{limited}");
        assert_eq!(not_worse(100.0, 0.0, |s| s), 0.0);
        // Worse than none everywhere, and before it is bent at all.
        assert_eq!(not_worse(5.0, 0.0, |s| 1.0 + error(s)), 0.0);
    }
}
