//! Logarithmic axes: the range that the data need and the ticks that people read.

use std::ops::Range;

/// Room beyond the outermost points, as a factor: 1 puts markers on the frame, 2 wastes a third of a decade.
const MARGIN: f64 = 1.25;
/// Least ratio of an axis' ends: below about 3 an axis may lack a tick, above 10 close points crowd together.
const LEAST_SPAN: f64 = 5.0;
/// Axis of data without one positive value: any range would do.
const NO_DATA: Range<f64> = 0.1..1.0;
/// Which multiples of each power of ten carry a label, from coarse to fine.
const LABELLED: [&[u8]; 2] = [&[1], &[1, 2, 5]];
/// Up to so many labels are too few to read a value off a logarithmic axis; the finer choice is taken, and its labels
/// do not touch as long as this stays below 4.
const ENOUGH_LABELS: usize = 3;
/// Powers of ten within are written out (0.001, 10000); beyond, as 10⁻⁴.
const WRITTEN_OUT: std::ops::RangeInclusive<i32> = -3..=4;
/// The powers of ten that a figure of this crate can reach; anything beyond is a mistake upstream and sits at the edge.
const DRAWABLE: Range<f64> = 1e-15..1e15;

/// The range of an axis that shows all positive values.
pub(super) fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    // Find the outermost values that a logarithm can show.
    let (low, high) = values
        .filter(|v| v.is_finite() && *v > 0.0)
        .map(|v| v.clamp(DRAWABLE.start, DRAWABLE.end))
        .fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return NO_DATA;
    }
    // Leave room around them, and around a single point too.
    let spread = (LEAST_SPAN / (high / low)).max(1.0).sqrt().max(MARGIN);
    low / spread..high * spread
}

/// A logarithmic axis.
pub(super) struct Scale {
    /// From its lower to its upper end.
    pub(super) range: Range<f64>,
    /// Its ticks.
    pub(super) ticks: Ticks,
    /// What labelled ticks say instead of their value; those that are not here say that.
    pub(super) words: Vec<(f64, String)>,
}

impl Scale {
    /// Over a range, with the ticks that people read.
    pub(super) fn over(range: Range<f64>) -> Self {
        let ticks = ticks(&range);
        Self { range, ticks, words: Vec::new() }
    }

    /// Of values of either sign, each placed at exp(asinh(value / linear)); ticks at zero, and at 1, 2 and 5 times the
    /// powers of ten from `linear` on.
    pub(super) fn signed(range: Range<f64>, linear: f64) -> Self {
        let place = |value: f64| (value / linear).asinh().exp();
        let most = [range.start, range.end].map(|end| (end.ln().sinh() * linear).abs()).into_iter().fold(0.0, f64::max);
        let sizes = |factors: &'static [u8], least: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "logarithms of finite numbers")]
            let exponents = (least.log10().floor() as i32)..=(most.max(least).log10().ceil() as i32);
            let sizes = exponents.flat_map(move |e| factors.iter().map(move |&factor| tick(factor, e)));
            let signed = sizes.filter(move |size| *size >= least).flat_map(|size| [-size, size]);
            signed.filter(|value| range.contains(&place(*value))).collect::<Vec<_>>()
        };
        let least = linear * (1.0 - 1e-9);
        let mut labelled = sizes(&[1, 2, 5], least);
        labelled.push(0.0);
        let faint = sizes(&[1, 2, 3, 4, 5, 6, 7, 8, 9], least).into_iter().map(place).collect();
        let words = labelled.iter().map(|value| (place(*value), signed_label(*value))).collect();
        let labelled = labelled.into_iter().map(place).filter(|at| range.contains(at)).collect();
        Self { range: range.clone(), ticks: Ticks { labelled, faint }, words }
    }

    /// How far along the axis a positive value is: 0 to 1 within its range.
    pub(super) fn share(&self, value: f64) -> f64 {
        (value / self.range.start).ln() / (self.range.end / self.range.start).ln()
    }

    /// What a labelled tick says.
    pub(super) fn says(&self, tick: f64) -> String {
        let word = self.words.iter().find(|(at, _)| (at / tick - 1.0).abs() < 1e-9);
        word.map_or_else(|| label(tick), |(_, word)| word.clone())
    }
}

/// Where ticks stand.
pub(super) struct Ticks {
    /// Ticks with a label and a strong line.
    pub(super) labelled: Vec<f64>,
    /// Faint lines between them: 2..9 times each power of ten.
    pub(super) faint: Vec<f64>,
}

/// Chooses ticks: powers of ten, and multiples of them when there are few.
fn ticks(range: &Range<f64>) -> Ticks {
    #[expect(clippy::cast_possible_truncation, reason = "the range lies within 1e-16..1e16")]
    let exponents = range.start.log10().floor() as i32..=range.end.log10().ceil() as i32;
    let multiples = |factors: &'static [u8]| {
        let inside = |v: &f64| range.contains(v);
        let at = |e: i32| factors.iter().map(move |&f| tick(f, e));
        exponents.clone().flat_map(at).filter(inside).collect::<Vec<_>>()
    };
    // Take the first choice that leaves the reader enough to go by.
    let labelled = LABELLED.into_iter().map(multiples).find(|t| t.len() > ENOUGH_LABELS);
    let labelled = labelled.unwrap_or_else(|| multiples(&[1, 2, 3, 5, 7]));
    Ticks { labelled, faint: multiples(&[2, 3, 4, 5, 6, 7, 8, 9]) }
}

/// `factor * 10^exponent`, rounded once, so that 0.1 is the 0.1 people write.
fn tick(factor: u8, exponent: i32) -> f64 {
    format!("{factor}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// Writes a tick: `0.02`, `500`, or `2×10⁻⁵` beyond what is easy to read.
fn label(value: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "ticks lie within 1e-16..1e16")]
    let exponent = (value.log10() + 1e-9).floor() as i32;
    if WRITTEN_OUT.contains(&exponent) {
        return format!("{value}");
    }
    let factor = (value / 10.0_f64.powi(exponent)).round();
    let power: String = exponent.to_string().chars().map(superscript).collect();
    if factor > 1.0 { format!("{factor}×10{power}") } else { format!("10{power}") }
}

/// The same of either sign.
fn signed_label(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        ..0.0 => format!("-{}", label(-value)),
        _ => label(value),
    }
}

/// A digit or sign, raised.
fn superscript(c: char) -> char {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    c.to_digit(10).map_or('⁻', |digit| RAISED[digit as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_holds_its_values_with_room_to_spare() {
        let r = range([0.01, 0.5, f64::NAN, 0.0, -1.0, f64::INFINITY].into_iter());
        assert!(r.start < 0.009 && r.start > 0.005 && r.end > 0.6 && r.end < 1.0, "{r:?}");
        let single = range([3.0].into_iter());
        assert!((single.end / single.start - LEAST_SPAN).abs() < 1e-9);
        assert_eq!(range([0.0, f64::NAN].into_iter()), NO_DATA);
        assert!(range([f64::MIN_POSITIVE, f64::MAX].into_iter()).end.is_finite());
    }

    #[test]
    fn every_axis_has_at_least_three_labelled_ticks() {
        // 1..10 in steps of 2 %: any axis of the least span is one of these, times a power of ten.
        let mut start = 1.0;
        while start < 10.0 {
            let t = ticks(&(start..start * LEAST_SPAN));
            assert!(t.labelled.len() >= 3, "{start}: {:?}", t.labelled);
            start *= 1.02;
        }
        assert_eq!(ticks(&(0.0002..3.0)).labelled, [0.001, 0.01, 0.1, 1.0]);
        assert_eq!(ticks(&(0.008..0.3)).labelled, [0.01, 0.02, 0.05, 0.1, 0.2]);
    }

    #[test]
    fn ticks_are_written_as_people_write_them() {
        let cases = [(0.02, "0.02"), (0.001, "0.001"), (10.0, "10"), (50_000.0, "50000")];
        for (value, text) in cases {
            assert_eq!(label(value), text);
        }
        assert_eq!(label(tick(1, -4)), "10⁻⁴");
        assert_eq!(label(tick(2, -5)), "2×10⁻⁵");
        assert_eq!(label(tick(5, 6)), "5×10⁶");
    }
}
