//! Searching a strength: one valley, no allocation, a fixed number of steps.
//!
//! # References
//! - Kiefer, *Sequential minimax search for a maximum*, 1953: golden-section search.
//! - Anderson & Björck, *A new high order method of regula falsi type for computing a root of an equation*, 1973.

/// The golden ratio less one.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Strengths are searched as κλ/(1 + κλ), from 0 (none) to 1 (endless): even steps of that are even steps of what they
/// do to a map.
fn share_of(strength: f64) -> f64 {
    strength / (1.0 + strength)
}

fn strength_of(share: f64) -> f64 {
    share / (1.0 - share)
}

/// Steps: each leaves 62 % of the interval. 26 leave 4e-6 of it, which moves no map of 16384 texels by one. Fewer show
/// as steps of the map when the camera moves; more are lost in the rounding of errors that are flat at the bottom.
const STEPS: u32 = 26;

/// Steps that leave 3 % of the interval, and a tenth of a per cent of the error.
const FEW_STEPS: u32 = 7;

/// κλ in [0, `limit`] of the least error; 0 where no strength is better than none.
///
/// Exact to 4e-6 (1 + κλ)² for errors that fall to one valley and rise behind it. 33 evaluations.
pub(crate) fn least(limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    least_in(STEPS, limit, error)
}

/// The same to 1e-2 (1 + κλ)², where the error itself is all that matters: it is flat there. 14 evaluations.
pub(crate) fn roughly_least(limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    least_in(FEW_STEPS, limit, error)
}

fn least_in(steps: u32, limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    let at = |share: f64| error(strength_of(share));
    let (mut low, mut high) = (0.0, share_of(limit));
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut error_left, mut error_right) = (at(left), at(right));
    for _ in 0..steps {
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
    // The ends are candidates themselves.
    let middle = strength_of(low.midpoint(high));
    let best = if error(limit) < error(middle) { limit } else { middle };
    if error(best) < error(0.0) { best } else { 0.0 }
}

/// Most steps in [`not_worse`]: false position with the remedy of Anderson and Björck takes half as many as a rule.
/// Fewer would stop short of the strength that is allowed where errors are far from straight; more is never needed.
const FALSE_POSITIONS: u32 = 14;

/// The strength itself where `error` is at most that of none; else the largest below it where that holds, or a little
/// less.
///
/// Continuous wherever `error` is and has one valley: that strength goes to 0 as the valley does. At most 17
/// evaluations.
pub(crate) fn not_worse(strength: f64, error: impl Fn(f64) -> f64) -> f64 {
    let uniform = error(0.0);
    let last = error(strength);
    if !(last > uniform) {
        return strength;
    }
    // The mean slope from 0: unlike the difference itself, it is not zero at 0 again, and over shares it is nearly
    // straight. A little is added, so that what is as good as zero is no worse than none.
    let slope_of = |strength: f64, error: f64| (error - uniform) / strength + CLOSE * uniform / (1.0 + strength);
    let slope = |share: f64| slope_of(strength_of(share), error(strength_of(share)));
    let mut high = (share_of(strength), slope_of(strength, last));
    // A valley begins at 0, if there is one.
    let near = high.0 * FIRST_STEP;
    let mut low = (near, slope(near));
    if low.1 >= 0.0 {
        return 0.0;
    }
    // Which end was replaced last; the other one's slope is weighed less if it is replaced again.
    let mut last_was_high = None;
    for _ in 0..FALSE_POSITIONS {
        let middle = (low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1)).clamp(low.0, high.0);
        let at = slope(middle);
        if at.abs() * strength_of(middle).max(1.0) < 0.5 * CLOSE * uniform {
            return strength_of(middle);
        }
        let is_high = at > 0.0;
        let again = last_was_high == Some(is_high);
        last_was_high = Some(is_high);
        let (replaced, other) = if is_high { (&mut high, &mut low) } else { (&mut low, &mut high) };
        if again {
            let share = 1.0 - at / replaced.1;
            other.1 *= if share > 0.0 { share } else { 0.5 };
        }
        *replaced = (middle, at);
    }
    strength_of(low.0)
}

/// When an error is as good as that of no warp, as a share of it. Smaller costs evaluations; at 1e-4 maps would show
/// where the search ends.
const CLOSE: f64 = 1e-6;

/// Where a valley is looked for, as a share of κλ/(1 + κλ): a valley that is over before is treated as none. Larger
/// misses shallow valleys, smaller sees nothing but rounding.
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
