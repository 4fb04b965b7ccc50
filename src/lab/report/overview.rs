//! The top of the page: how much was run, what a reader must know, and which runs no other run beats.

use std::io::{self, Write};

use super::html::Escaped;
use super::{Report, Row};

/// Writes counts, notes and the runs that no other run beats.
pub(super) fn write(sink: &mut impl Write, report: &Report) -> io::Result<()> {
    writeln!(
        sink,
        "<section id=\"summary\" aria-labelledby=\"summary-title\">\n<h2 id=\"summary-title\">Summary</h2>"
    )?;
    write_counts(sink, report)?;
    for note in &report.notes {
        writeln!(sink, "<p class=\"note\">{}</p>", Escaped(note))?;
    }
    write_fronts(sink, report)?;
    writeln!(sink, "</section>")
}

/// Writes how much was run.
fn write_counts(sink: &mut impl Write, report: &Report) -> io::Result<()> {
    let techniques = super::curves::technique_order(report).len();
    let failed = report.rows().filter(|row| row.failed()).count();
    writeln!(sink, "<ul class=\"counts\">")?;
    for (count, one, many) in [
        (report.scenes.len(), "case", "cases"),
        (techniques, "technique", "techniques"),
        (report.rows().count(), "run", "runs"),
        (failed, "failed run", "failed runs"),
    ] {
        let class = if many == "failed runs" && count > 0 { " class=\"bad\"" } else { "" };
        writeln!(sink, "<li{class}><b>{count}</b> {}</li>", if count == 1 { one } else { many })?;
    }
    writeln!(sink, "</ul>")
}

/// Writes for every case the runs that no other run beats in both picture error and time.
fn write_fronts(sink: &mut impl Write, report: &Report) -> io::Result<()> {
    if report.rows().all(Row::failed) {
        return writeln!(sink, "<p class=\"hint\">No run was measured, so there is nothing to compare.</p>");
    }
    writeln!(
        sink,
        "<p class=\"hint\">For each case, the runs worth a look: no other run had both a smaller picture error (mae) and \
         a shorter frame. From fast to accurate; what lies between is a matter of budget, not of rank.</p>\n\
         <div class=\"fronts\">"
    )?;
    for (index, section) in report.scenes.iter().enumerate() {
        writeln!(
            sink,
            "<div class=\"front\"><h3><a href=\"#scene-{index}\">{} <span class=\"case\">{}</span></a></h3><ol>",
            Escaped(&section.scene),
            Escaped(&section.case)
        )?;
        for row in front(&section.rows) {
            writeln!(
                sink,
                "<li><b>{}</b> <span class=\"size\">{}</span><span class=\"figures\">{} ms, mae {}</span></li>",
                Escaped(&row.technique),
                row.size,
                super::Cell::Milliseconds(row.total_ms).text(),
                super::Cell::Difference(row.mae).text()
            )?;
        }
        writeln!(sink, "</ol></div>")?;
    }
    writeln!(sink, "</div>")
}

/// The rows that no other row beats in both `mae` and `total_ms`, from fast to accurate.
fn front(rows: &[Row]) -> Vec<&Row> {
    let measured = || rows.iter().filter(|row| row.mae.is_finite() && row.total_ms.is_finite());
    let beats =
        |a: &Row, b: &Row| a.mae <= b.mae && a.total_ms <= b.total_ms && (a.mae < b.mae || a.total_ms < b.total_ms);
    let mut front: Vec<&Row> = measured().filter(|row| !measured().any(|other| beats(other, row))).collect();
    front.sort_by(|a, b| a.total_ms.total_cmp(&b.total_ms));
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let row = |technique: &str, mae, total_ms| Row { technique: technique.into(), mae, total_ms, ..Row::default() };
        let rows = [
            row("accurate", 0.01, 3.0),
            row("fast", 0.05, 1.0),
            row("beaten", 0.05, 1.1),
            row("between", 0.03, 2.0),
            row("failed", f64::NAN, 0.5),
        ];
        let names: Vec<_> = front(&rows).iter().map(|row| row.technique.as_str()).collect();
        assert_eq!(names, ["fast", "between", "accurate"]);
    }
}
