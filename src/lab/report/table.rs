//! All rows of one scene as a sortable table, and all they left out, word for word.

use std::io::{self, Write};

use super::column::{self, Cell, Column};
use super::html::Escaped;
use super::{Row, SceneSection};

/// The columns in the order of the page: what is asked for most stands first.
/// Scene and case are in the section's heading.
const SHOWN: [&str; 28] = [
    "technique",
    "size",
    "total_ms",
    "mae",
    "floor_mae",
    "excess",
    "rmse",
    "wrong_center",
    "wrong",
    "edge_center_px",
    "leak_edge",
    "leak_interior",
    "false_edge",
    "false_interior",
    "predicted_px",
    "fit_ns",
    "casters_ms",
    "filter_ms",
    "receivers_ms",
    "views",
    "texels",
    "bytes",
    "split",
    "warp",
    "encoding",
    "backend",
    "adapter",
    "left_out",
];
/// Columns with a bar behind their figures: the ones a reader scans first.
const WITH_BAR: [&str; 4] = ["total_ms", "mae", "wrong_center", "bytes"];

/// Writes the table.
pub(super) fn write(sink: &mut impl Write, section: &SceneSection) -> io::Result<()> {
    writeln!(sink, "<div class=\"bar\"><h3>All figures</h3>")?;
    if section.rows.is_empty() {
        return writeln!(sink, "</div><p class=\"hint\">No run, no figures.</p>");
    }
    writeln!(
        sink,
        "<label class=\"filter needs-script\">Filter <input type=\"search\" placeholder=\"technique, warp, …\"></label>\n</div>\n\
         <p class=\"hint\">Click a heading to sort, again to turn the order around; its tooltip says what it means. NaN: not measured.</p>\n\
         <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All figures of {}, {}\">\n<table class=\"sortable\">\n<thead><tr>",
        Escaped(&section.scene),
        Escaped(&section.case)
    )?;
    let columns: Vec<&Column> = SHOWN.iter().filter_map(|name| column::find(name)).collect();
    for column in &columns {
        write_heading(sink, column)?;
    }
    writeln!(sink, "</tr></thead>\n<tbody>")?;
    let largest: Vec<f64> = columns.iter().map(|column| largest(column, &section.rows)).collect();
    for row in &section.rows {
        write!(sink, "<tr{}>", if row.failed() { " class=\"failed\"" } else { "" })?;
        for (column, &largest) in columns.iter().zip(&largest) {
            write_cell(sink, column, row, largest)?;
        }
        writeln!(sink, "</tr>")?;
    }
    writeln!(sink, "</tbody></table></div>")
}

/// Writes a heading that sorts.
fn write_heading(sink: &mut impl Write, Column { name, heading, unit, meaning, cell }: &Column) -> io::Result<()> {
    let class = if cell(&Row::default()).number().is_some() { "n" } else { "t" };
    let unit = if unit.is_empty() { String::new() } else { format!(" <small>{unit}</small>") };
    write!(
        sink,
        "<th scope=\"col\" class=\"{class} c-{name}\"><button type=\"button\" title=\"{}\">{heading}{unit}</button></th>",
        Escaped(meaning)
    )
}

/// Writes a cell; numbers carry their full value for sorting.
fn write_cell(sink: &mut impl Write, column: &Column, row: &Row, largest: f64) -> io::Result<()> {
    let cell = (column.cell)(row);
    match (cell, cell.number()) {
        (Cell::Lines(lines), _) => write_lines(sink, lines),
        (_, None) if column.name == "technique" => write!(sink, "<th scope=\"row\">{}</th>", Escaped(&cell.text())),
        (_, None) => write!(sink, "<td>{}</td>", Escaped(&cell.text())),
        (_, Some(value)) if value.is_nan() => write!(sink, "<td class=\"n nan\" data-v=\"NaN\">NaN</td>"),
        (_, Some(value)) if WITH_BAR.contains(&column.name) && largest > 0.0 => {
            let share = (100.0 * value / largest).clamp(0.0, 100.0);
            write!(sink, "<td class=\"n b\" data-v=\"{value:e}\" style=\"--w:{share:.1}%\">{}</td>", cell.text())
        }
        (_, Some(value)) => write!(sink, "<td class=\"n\" data-v=\"{value:e}\">{}</td>", cell.text()),
    }
}

/// Writes the lines of a cell, folded behind the first.
fn write_lines(sink: &mut impl Write, lines: &[String]) -> io::Result<()> {
    let Some((first, rest)) = lines.split_first() else { return write!(sink, "<td class=\"cut\"></td>") };
    let more = if rest.is_empty() { String::new() } else { format!(" <i>+{}</i>", rest.len()) };
    write!(sink, "<td class=\"cut\"><details><summary><span>{}</span>{more}</summary><ul>", Escaped(first))?;
    for line in lines {
        write!(sink, "<li>{}</li>", Escaped(line))?;
    }
    write!(sink, "</ul></details></td>")
}

/// The largest finite value of a column, 0 when there is none.
fn largest(column: &Column, rows: &[Row]) -> f64 {
    rows.iter().filter_map(|row| (column.cell)(row).number()).filter(|v| v.is_finite()).fold(0.0, f64::max)
}

/// Writes what failed, then what was left out: each line once, with the runs that said it.
pub(super) fn write_left_out(sink: &mut impl Write, section: &SceneSection) -> io::Result<()> {
    let (failed, fine): (Vec<&Row>, Vec<&Row>) = section.rows.iter().partition(|row| row.failed());
    if !failed.is_empty() {
        writeln!(sink, "<h3>Failed runs</h3>\n<ul class=\"left-out failed\">")?;
        for row in failed {
            let why = if row.left_out.is_empty() { "no reason given".to_owned() } else { row.left_out.join("\n") };
            write_line(sink, &why, &[row])?;
        }
        writeln!(sink, "</ul>")?;
    }
    let lines = gather(&fine);
    writeln!(sink, "<h3>What was left out</h3>")?;
    if lines.is_empty() {
        let what = if fine.is_empty() {
            "No run got far enough to tell."
        } else {
            "Nothing: no technique skipped, clamped or replaced a step here."
        };
        return writeln!(sink, "<p class=\"hint\">{what}</p>");
    }
    writeln!(
        sink,
        "<details class=\"fold\"{}><summary>{} {}, word for word, with the runs that reported {}</summary>\n<ul class=\"left-out\">",
        if lines.len() <= FEW_LINES { " open" } else { "" },
        lines.len(),
        if lines.len() == 1 { "line" } else { "lines" },
        if lines.len() == 1 { "it" } else { "them" },
    )?;
    for (line, runs) in &lines {
        write_line(sink, line, runs)?;
    }
    writeln!(sink, "</ul></details>")
}

/// Up to so many lines are shown unfolded; more would push the table off the screen.
const FEW_LINES: usize = 8;

/// Every distinct line in order of appearance, with the runs that reported it.
fn gather<'a>(rows: &[&'a Row]) -> Vec<(&'a str, Vec<&'a Row>)> {
    let mut lines: Vec<(&str, Vec<&Row>)> = Vec::new();
    for row in rows {
        for line in &row.left_out {
            match lines.iter_mut().find(|(known, _)| known == line) {
                Some((_, runs)) => runs.push(row),
                None => lines.push((line, vec![row])),
            }
        }
    }
    lines
}

/// Writes one line and its runs.
fn write_line(sink: &mut impl Write, line: &str, runs: &[&Row]) -> io::Result<()> {
    writeln!(sink, "<li><q>{}</q> <span class=\"runs\">{}</span></li>", Escaped(line), Escaped(&run_names(runs)))
}

/// Names runs, each technique once with its map sizes: `ssm 512, 1024 · psm 512`.
fn run_names(runs: &[&Row]) -> String {
    let mut names: Vec<(&str, String)> = Vec::new();
    for row in runs {
        match names.last_mut().filter(|(technique, _)| *technique == row.technique) {
            Some((_, text)) => text.extend([", ", &row.size.to_string()]),
            None => names.push((&row.technique, format!("{} {}", row.technique, row.size))),
        }
    }
    names.into_iter().map(|(_, text)| text).collect::<Vec<_>>().join(" · ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_is_shown_but_those_of_the_heading() {
        for column in &column::COLUMNS {
            let in_heading = ["scene", "case"].contains(&column.name);
            assert_eq!(SHOWN.contains(&column.name), !in_heading, "{}", column.name);
        }
        assert!(SHOWN.iter().all(|name| column::find(name).is_some()));
    }

    #[test]
    fn runs_are_named_by_technique() {
        let row = |technique: &str, size| Row { technique: technique.into(), size, ..Row::default() };
        let runs = [row("ssm", 512), row("ssm", 1024), row("psm", 512)];
        assert_eq!(run_names(&runs.iter().collect::<Vec<_>>()), "ssm 512, 1024 · psm 512");
    }
}
