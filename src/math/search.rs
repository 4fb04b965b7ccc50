//! Searching one number: valleys of strengths and of other things, roots, no allocation, few steps at most.
//!
//! # References
//! - Brent, *Algorithms for minimization without derivatives*, 1973, chapter 5: parabolas and golden sections.
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

/// How far from the least share the search may end: it moves no map of 16384 texels by one. Larger
/// shows as steps of the map when the camera moves; smaller is lost in the rounding of errors that are flat at the
/// bottom.
const FINE: f64 = 2e-6;

/// The same where the error itself is all that matters: it is flat, and this is a tenth of a per cent of it.
const ROUGH: f64 = 1e-2;

/// Most steps: golden sections alone take 27 to [`FINE`]; parabolas that do not come closer can double that.
const MOST_STEPS: u32 = 54;

/// κλ in [0, `limit`] of the least error; 0 where no strength is better than none.
///
/// Exact to 4e-6 (1 + κλ)² for errors that fall to one valley and rise behind it. About 15 evaluations where they are
/// smooth.
pub(crate) fn least(limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    least_in(FINE, limit, error)
}

/// The same to 2e-2 (1 + κλ)². About 8 evaluations.
pub(crate) fn roughly_least(limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    least_in(ROUGH, limit, error)
}

fn least_in(tolerance: f64, limit: f64, error: impl Fn(f64) -> f64) -> f64 {
    let (share, least) = valley([0.0, share_of(limit)], tolerance, |share| error(strength_of(share)));
    // The ends are candidates themselves.
    let last = error(limit);
    let (best, least) = if last < least { (limit, last) } else { (strength_of(share), least) };
    if least < error(0.0) { best } else { 0.0 }
}

/// How much of the way between the ends may be left when the first of them is asked whether it is the bottom. Sooner
/// asks for nothing; later takes more steps towards it.
const NARROW: f64 = 1.0 / 16.0;

/// The bottom of a valley between two places, and the error there: Brent's method, parabolas through the three best
/// points, and golden sections where those lead nowhere.
pub(crate) fn valley([mut low, mut high]: [f64; 2], tolerance: f64, error: impl Fn(f64) -> f64) -> (f64, f64) {
    let start = low + (1.0 - GOLDEN) * (high - low);
    let at_start = (start, error(start));
    let [mut best, mut second, mut third] = [at_start; 3];
    let (mut step, mut before) = (0.0_f64, 0.0_f64);
    let (first, narrow) = (low, low + NARROW * (high - low));
    let mut asked = false;
    for _ in 0..MOST_STEPS {
        // Where the first end may be the bottom, what lies beside it says so at once.
        if !asked && low == first && high < narrow {
            asked = true;
            let at_first = error(first);
            if at_first <= error(first + 2.0 * tolerance) {
                return (first, at_first);
            }
        }
        let middle = low.midpoint(high);
        if (best.0 - middle).abs() <= 2.0 * tolerance - 0.5 * (high - low) {
            break;
        }
        let parabola = bottom(best, second, third);
        let small = parabola.abs() < 0.5 * before.abs();
        if small && low < best.0 + parabola && best.0 + parabola < high {
            (before, step) = (step, parabola);
            // Not at the ends, where nothing would be learnt.
            if best.0 + step - low < 2.0 * tolerance || high - best.0 - step < 2.0 * tolerance {
                step = tolerance.copysign(middle - best.0);
            }
        } else {
            before = if best.0 < middle { high - best.0 } else { low - best.0 };
            step = (1.0 - GOLDEN) * before;
        }
        let place = best.0 + if step.abs() >= tolerance { step } else { tolerance.copysign(step) };
        let tried = (place, error(place));
        if tried.1 <= best.1 {
            *(if tried.0 < best.0 { &mut high } else { &mut low }) = best.0;
            (third, second, best) = (second, best, tried);
        } else {
            *(if tried.0 < best.0 { &mut low } else { &mut high }) = tried.0;
            if tried.1 <= second.1 || second.0 == best.0 {
                (third, second) = (second, tried);
            } else if tried.1 <= third.1 || third.0 == best.0 || third.0 == second.0 {
                third = tried;
            }
        }
    }
    best
}

/// Step from a point to the bottom of the parabola through three; not finite where there is none.
fn bottom(best: (f64, f64), second: (f64, f64), third: (f64, f64)) -> f64 {
    let one = (best.0 - second.0) * (best.1 - third.1);
    let other = (best.0 - third.0) * (best.1 - second.1);
    -((best.0 - second.0) * one - (best.0 - third.0) * other) / (2.0 * (one - other))
}

/// Most steps in [`crossing`]: false position takes four to six where the function is nearly straight.
const CROSSING_STEPS: u32 = 12;

/// The place between `inside`, where `excess` is not positive, and `outside`, where it is, at which it is at most
/// `close`; or one nearer to `inside`. False position, Illinois.
pub(crate) fn crossing(inside: f64, outside: f64, close: f64, excess: impl Fn(f64) -> f64) -> f64 {
    let (mut inside, mut outside) = ((inside, excess(inside)), (outside, excess(outside)));
    let mut last = None;
    for _ in 0..CROSSING_STEPS {
        let place = inside.0 - inside.1 * (outside.0 - inside.0) / (outside.1 - inside.1);
        let at = excess(place);
        if !(at.abs() > close) {
            return place;
        }
        let is_outside = at > 0.0;
        let again = last == Some(is_outside);
        last = Some(is_outside);
        let (replaced, kept) = if is_outside { (&mut outside, &mut inside) } else { (&mut inside, &mut outside) };
        *replaced = (place, at);
        // An end that stays twice is weighed less.
        kept.1 *= if again { 0.5 } else { 1.0 };
    }
    inside.0
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
