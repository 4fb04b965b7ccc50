//! Rows as a Markdown table, for the records kept in `docs/`.

use std::fmt::Write as _;

use super::ReportError;
use super::column::{self, Cell, Column};
use super::row::Row;

/// Renders rows as a Markdown table with these columns, by their names in `results.csv` (or `excess`).
///
/// # Errors
/// [`ReportError::UnknownColumn`] when there is no column of that name.
pub fn markdown_table(rows: &[Row], columns: &[&str]) -> Result<String, ReportError> {
    // Look every column up before anything is written.
    let columns = columns
        .iter()
        .map(|&name| column::find(name).ok_or_else(|| ReportError::UnknownColumn { name: name.to_owned() }))
        .collect::<Result<Vec<_>, _>>()?;
    // Write the headings, then how each column is aligned.
    let blank = Row::default();
    let mut table = line(columns.iter().map(|column| heading(column)));
    table += &line(columns.iter().map(|column| match (column.cell)(&blank).number() {
        Some(_) => "---:".to_owned(),
        None => "---".to_owned(),
    }));
    // Write the rows.
    for row in rows {
        table += &line(columns.iter().map(|column| escape((column.cell)(row))));
    }
    Ok(table)
}

/// The heading with its unit.
fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.heading.to_owned() } else { format!("{} ({})", column.heading, column.unit) }
}

/// One line of the table.
fn line(cells: impl Iterator<Item = String>) -> String {
    let mut line = cells.fold("|".to_owned(), |mut line, cell| {
        let _ = write!(line, " {cell} |");
        line
    });
    line.push('\n');
    line
}

/// The cell's text, kept within its cell and free of HTML.
fn escape(cell: Cell<'_>) -> String {
    cell.text().replace('|', "\\|").replace(['\n', '\r'], " ").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_line_per_row_and_keeps_its_cells() {
        let rows = [
            Row { technique: "a|b <x>".into(), size: 1024, mae: 0.0213, wrong: 0.01, ..Row::default() },
            Row { technique: "failed".into(), size: 512, left_out: vec!["out of\nmemory".into()], ..Row::default() },
        ];
        let table = markdown_table(&rows, &["technique", "size", "mae", "wrong", "left_out"]).unwrap();
        let expected = "| technique | size | mae | wrong (%) | left out |\n\
                        | --- | ---: | ---: | ---: | --- |\n\
                        | a\\|b &lt;x> | 1024 | 0.0213 | 1.00 |  |\n\
                        | failed | 512 | NaN | NaN | out of memory |\n";
        assert_eq!(table, expected);
    }

    #[test]
    fn an_unknown_column_is_named_with_the_legal_ones() {
        let error = markdown_table(&[], &["speed"]).unwrap_err().to_string();
        assert!(error.contains("speed") && error.contains("total_ms") && error.contains("excess"), "{error}");
    }
}
