//! The page of filters.

use std::fmt::Write as _;

use antumbra::lab::report::{Axes, Axis, PlotPoint, Series, error_time_svg};
use antumbra::lab::statistics::{geometric_mean, mean};

use crate::contenders::{Memory, PCF};
use crate::measure::{Record, Time};

/// Width from which filters are called wide, texels.
const WIDE: u32 = 15;

/// Mean error that one picture may have above another and still be called no worse: half a grey level of 255.
const SAME: f64 = 0.002;

const HEAD: &str = "# Moments and percentage-closer filtering

This page is written by the command below; every number on it comes from that run.
";

/// `{turns}` is filled in.
const TABLE: &str = "
One focused map of 1024 texels, a box of so many texels everywhere, no mips, no darkening. *PCF* compares first and averages then, with
(n + 1)/2 bilinear comparisons to an axis, which weigh texels exactly as the moments' box and their interpolation do: it is the same
penumbra without the loss, and *from PCF* is the root mean square distance from its picture (over valid pixels, 0 to 1). *Filter*,
*receivers* and *total* are milliseconds of the adapter: medians of {turns} turns, in which contenders follow each other forwards and
backwards in alternation, after one that is not timed; ± half the distance between the quartiles; both are means over cases. Widths are
drawn one after another: sums are the same work at every width, and what their *filter* differs by between widths is what the machine did
meanwhile. *÷ PCF* is the total over PCF's, geometric mean. *Excess* is the mean absolute error against the area truth above that of a perfect hard edge, %: wide filters soften what the truth
has hard, PCF as well. *Leak* and *false*: pixels more than half wrong away from edges, %. Moments err towards light: their *excess* is low
also because they leak where a wide PCF shades too much. Read *leak* and *from PCF* beside it.
";

fn of<'a>(records: &'a [Record], width: u32, name: &str) -> Vec<&'a Record> {
    records.iter().filter(|record| record.width == width && record.name == name).collect()
}

fn names(records: &[Record]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for record in records {
        if !names.contains(&record.name.as_str()) {
            names.push(&record.name);
        }
    }
    names
}

fn widths(records: &[Record]) -> Vec<u32> {
    let mut widths: Vec<u32> = records.iter().map(|record| record.width).collect();
    widths.sort_unstable();
    widths.dedup();
    widths
}

/// Mean over cases, and mean spread.
fn time(records: &[&Record], of: impl Fn(&Record) -> Time) -> String {
    format!("{:.1} ± {:.1}", average(records, |record| of(record).ms), average(records, |record| of(record).spread))
}

fn average(records: &[&Record], figure: impl Fn(&Record) -> f64) -> f64 {
    mean(&records.iter().map(|record| figure(record)).collect::<Vec<_>>())
}

pub(crate) fn page(meta: &[(&str, String)], turns: u32, records: &[Record], memory: &[Memory]) -> String {
    let mut text = HEAD.to_owned();
    text.push('\n');
    for (name, value) in meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    text.push_str(&TABLE.replace("{turns}", &turns.to_string()));
    text.push_str("\n![time by width](filters-time.svg)\n\n![distance from the same penumbra](filters-distance.svg)\n");
    for width in widths(records) {
        table(&mut text, records, width);
    }
    wide(&mut text, records);
    text.push_str("\n## Memory\n\nOne map of 1024 texels with everything that fills it: the depths, the filtered map, and what one pass leaves for the next.\n");
    text.push_str("\n| encoding | bytes a texel that receivers read | MiB | MiB with mips |\n|---|--:|--:|--:|\n");
    for Memory { name, texel, bytes } in memory {
        let [plain, mips] = bytes.map(|bytes| bytes as f64 / f64::from(1 << 20));
        let _ = writeln!(text, "| {name} | {texel} | {plain:.1} | {mips:.1} |");
    }
    text
}

fn table(text: &mut String, records: &[Record], width: u32) {
    let _ = writeln!(
        text,
        "\n| {width} texels | filter | receivers | total | ÷ PCF | excess | from PCF | leak | false |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|"
    );
    for name in names(records) {
        let these = of(records, width, name);
        let pcf = of(records, width, PCF);
        let ratios: Vec<f64> = these.iter().zip(&pcf).map(|(one, pcf)| one.total.ms / pcf.total.ms).collect();
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {:.2} | {:.2} | {:.4} | {:.3} | {:.3} |",
            time(&these, |record| record.filter),
            time(&these, |record| record.receivers),
            time(&these, |record| record.total),
            geometric_mean(&ratios),
            100.0 * average(&these, |record| record.excess),
            average(&these, |record| record.distance),
            100.0 * average(&these, |record| record.leak),
            100.0 * average(&these, |record| record.acne),
        );
    }
}

/// Whether a wide filter is cheaper as moments without more error, picture by picture.
fn wide(text: &mut String, records: &[Record]) {
    let _ = writeln!(
        text,
        "\n## Wide filters\n\nFrom {WIDE} texels on: the fastest moments whose mean error is no more than PCF's (within {:.1} %, half a grey level).\n",
        100.0 * SAME
    );
    text.push_str(
        "| case | width | PCF ms | moments | ms | ÷ PCF | excess, PCF's | holds |\n|---|--:|--:|---|--:|--:|--:|---|\n",
    );
    let (mut held, mut count) = (0, 0);
    for pcf in records.iter().filter(|record| record.name == PCF && record.width >= WIDE) {
        let same = |record: &&Record| record.case == pcf.case && record.width == pcf.width && record.name != PCF;
        let good = records.iter().filter(same).filter(|record| record.mae <= pcf.mae + SAME);
        let best = good.min_by(|a, b| a.total.ms.total_cmp(&b.total.ms));
        let holds = best.is_some_and(|best| best.total.ms < pcf.total.ms);
        (held, count) = (held + usize::from(holds), count + 1);
        let found = best.map_or_else(
            || "none | – | – | –".to_owned(),
            |best| {
                let (ms, ratio) = (best.total.ms, best.total.ms / pcf.total.ms);
                format!("{} | {ms:.1} | {ratio:.2} | {:.2}", best.name, 100.0 * best.excess)
            },
        );
        let (case, width, ms) = (&pcf.case, pcf.width, pcf.total.ms);
        let (excess, holds) = (100.0 * pcf.excess, if holds { "yes" } else { "**no**" });
        let _ = writeln!(text, "| {case} | {width} | {ms:.1} | {found}, {excess:.2} | {holds} |");
    }
    let _ = writeln!(text, "\nThe best moments are faster than PCF at no more error in {held} of {count} pictures.");
}

/// Time by width, and distance from the same penumbra by time.
pub(crate) fn plots(records: &[Record]) -> [(&'static str, String); 2] {
    let series = |x: &dyn Fn(u32, &[&Record]) -> f64, y: &dyn Fn(&[&Record]) -> f64| -> Vec<Series> {
        let curve = |(style, name): (usize, &str)| {
            let point = |width: &u32| {
                let these = of(records, *width, name);
                PlotPoint { x: x(*width, &these), y: y(&these), label: width.to_string() }
            };
            Series { name: name.to_owned(), style, points: widths(records).iter().map(point).collect() }
        };
        names(records).into_iter().enumerate().map(curve).collect()
    };
    let time = |these: &[&Record]| average(these, |record| record.total.ms);
    let axis = |name: &str| Axis { name: name.to_owned(), ..Axis::default() };
    let by_width = series(&|width, _| f64::from(width), &time);
    let mut by_distance = series(&|_, these| average(these, |record| record.distance), &time);
    by_distance.retain(|series| series.name != PCF);
    [
        (
            "filters-time.svg",
            error_time_svg(
                "Time by width",
                &by_width,
                &Axes {
                    x: axis("width of the filter, texels"),
                    y: axis("filter and receivers, ms"),
                    ..Axes::default()
                },
            ),
        ),
        (
            "filters-distance.svg",
            error_time_svg(
                "Distance from PCF of the same width, and time",
                &by_distance,
                &Axes {
                    x: axis("root mean square distance from PCF's picture"),
                    y: axis("filter and receivers, ms"),
                    ..Axes::default()
                },
            ),
        ),
    ]
}
