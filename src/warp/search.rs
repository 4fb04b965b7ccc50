//! Searching a strength: one valley, no allocation, a fixed number of steps.
//!
//! # References
//! - Kiefer, *Sequential minimax search for a maximum*, 1953: golden-section search.

/// The golden ratio less one.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Steps: each leaves 62 % of the interval. 12 leave 1/322 of it; parabolas do the rest. Fewer show as
/// steps of the map when the camera moves; more cost time.
const STEPS: u32 = 12;

/// κλ in [0, `limit`] of the least error; 0 where no strength is better than none.
///
/// Exact to about 1e-4 of 1 + κλ for smooth errors that fall to one valley and rise behind it. 20 evaluations.
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
    let (rough, narrow) = (bottom(&at, low, high), NARROWER * (high - low));
    let best = bottom(&at, (rough - narrow).max(0.0), rough + narrow);
    if at(best) < error(0.0) { best.exp_m1() } else { 0.0 }
}

/// The second parabola's half width, as a share of the first's width: where the error has a kink, the first one is off by as much. Much
/// smaller, and rounding decides.
const NARROWER: f64 = 1.0 / 32.0;

/// Where the parabola through a function's values at the ends and in the middle of an interval is least.
fn bottom(at: &impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (middle, half) = (low.midpoint(high), 0.5 * (high - low));
    let (before, here, after) = (at(low), at(middle), at(high));
    let curvature = before - 2.0 * here + after;
    if curvature > 0.0 { (middle + 0.5 * half * (before - after) / curvature).clamp(low, high) } else { middle }
}

/// Steps in [`not_worse`]: false position with Illinois' remedy gains more than a digit each.
const FALSE_POSITIONS: u32 = 9;

/// The strength itself where `error` is at most that of none; else the largest below it where that holds, or a little less.
///
/// Continuous wherever `error` is and has one valley: that strength goes to 0 as the valley does. At most 12 evaluations.
pub(crate) fn not_worse(strength: f64, error: impl Fn(f64) -> f64) -> f64 {
    let uniform = error(0.0);
    let last = error(strength) - uniform;
    if !(last > 0.0) {
        return strength;
    }
    // The mean slope from 0: unlike the difference itself, it is not zero at 0 again.
    let slope = |log: f64| (error(log.exp_m1()) - uniform) / log;
    let mut high = (strength.ln_1p(), last / strength.ln_1p());
    // A valley begins at 0, if there is one.
    let near = high.0 * FIRST_STEP;
    let mut low = (near, slope(near));
    if low.1 >= 0.0 {
        return 0.0;
    }
    for _ in 0..FALSE_POSITIONS {
        let middle = (low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1)).clamp(low.0, high.0);
        let at = slope(middle);
        if at > 0.0 {
            high = (middle, at);
            low.1 *= 0.5;
        } else {
            low = (middle, at);
            high.1 *= 0.5;
        }
    }
    low.0.exp_m1()
}

/// Where a valley is looked for, as a share of ln(1 + κλ): a valley that is over before is treated as none. Larger misses shallow
/// valleys, smaller sees nothing but rounding.
const FIRST_STEP: f64 = 1.0 / 1024.0;

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
        assert_eq!(not_worse(5.0, error), 5.0);
        let limited = not_worse(100.0, error);
        assert!((limited - 8.0).abs() < 0.02 && error(limited) <= error(0.0), "{limited}");
        assert_eq!(not_worse(100.0, |s| s), 0.0);
    }
}
