//! `results.csv`: one header row, one line per measured point, quoted after RFC 4180.

use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::Path;

use serde::Serialize;

use super::row::Row;
use super::{ReportError, column, stage};

/// Opens a line that is no row: `# command: ...`.
const COMMENT: u8 = b'#';
/// Columns that the file holds: all that a [`Row`] stores, without the derived ones at the end of the list.
const STORED_COLUMNS: usize = 29;

/// The columns of `results.csv`, in order.
pub fn header() -> impl Iterator<Item = &'static str> {
    column::COLUMNS[..STORED_COLUMNS].iter().map(|column| column.name)
}

/// Writes the rows to a file, all or nothing.
///
/// Each pair of `meta` becomes a line `# key: value` above the header (machine, commit and command of a committed
/// record); with no pairs the file is plain RFC 4180. A figure that was not measured is `NaN`.
///
/// # Errors
/// [`ReportError`] naming the path when the file cannot be written.
pub fn write_csv(path: &Path, meta: &[(&str, &str)], rows: &[Row]) -> Result<(), ReportError> {
    let staged = stage::write(path, |sink| write_rows(sink, meta, rows))?;
    stage::publish([staged])
}

/// The same with more columns at the end, by name.
///
/// # Errors
/// As [`write_csv`], also when a row does not bring as many figures as there are names.
pub fn write_wide_csv(
    path: &Path,
    meta: &[(&str, &str)],
    more: &[&str],
    rows: &[(Row, Vec<f64>)],
) -> Result<(), ReportError> {
    let mut columns: Vec<&str> = header().collect();
    columns.extend(more);
    let staged = stage::write(path, |sink| write_records(sink, meta, &columns, rows))?;
    stage::publish([staged])
}

/// Writes comments, header and rows.
pub(super) fn write_rows<'a, W: Write>(
    sink: W,
    meta: &[(&str, &str)],
    rows: impl IntoIterator<Item = &'a Row>,
) -> io::Result<()> {
    write_records(sink, meta, &header().collect::<Vec<_>>(), rows)
}

/// Writes comments, header and what a line is made of.
fn write_records<W: Write>(
    mut sink: W,
    meta: &[(&str, &str)],
    header: &[&str],
    rows: impl IntoIterator<Item = impl Serialize>,
) -> io::Result<()> {
    // A comment is one line, whatever the value holds.
    for (key, value) in meta {
        writeln!(sink, "# {key}: {}", value.split_whitespace().collect::<Vec<_>>().join(" "))?;
    }
    // The header stands even above no rows.
    let mut table = csv::WriterBuilder::new().comment(Some(COMMENT)).has_headers(false).from_writer(sink);
    table.write_record(header)?;
    for row in rows {
        table.serialize(row)?;
    }
    table.flush()
}

/// Reads the rows of a file that [`write_csv`] wrote; the order of its columns does not matter.
///
/// # Errors
/// [`ReportError`] naming the path, and the line when a cell is not what its column holds.
pub fn read_csv(path: &Path) -> Result<Vec<Row>, ReportError> {
    let file = File::open(path).map_err(|source| ReportError::Unreadable { path: path.to_owned(), source })?;
    let mut table = csv::ReaderBuilder::new().comment(Some(COMMENT)).from_reader(BufReader::new(file));
    table
        .deserialize()
        .collect::<Result<_, csv::Error>>()
        .map_err(|source| ReportError::NotOurTable { path: path.to_owned(), source: Box::new(source) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(meta: &[(&str, &str)], rows: &[Row]) -> String {
        let mut bytes = Vec::new();
        write_rows(&mut bytes, meta, rows).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    fn awkward() -> Row {
        Row {
            scene: "#1, \"quoted\"".into(),
            technique: "two\nlines".into(),
            size: 512,
            mae: 0.125,
            left_out: vec!["view 3: no receivers in [812, 1400]".into(), "split: 4 → 3".into()],
            ..Row::default()
        }
    }

    #[test]
    fn the_header_is_the_order_of_the_fields() {
        let mut bytes = Vec::new();
        let mut table = csv::Writer::from_writer(&mut bytes);
        table.serialize(Row::default()).unwrap();
        drop(table);
        let of_serde = String::from_utf8(bytes).unwrap().lines().next().unwrap().to_owned();
        assert_eq!(of_serde, header().collect::<Vec<_>>().join(","));
        assert!(
            text(&[], &[]).starts_with("scene,case,technique,split,warp,encoding,size,views,texels,bytes,backend,")
        );
    }

    #[test]
    fn nan_is_written_out_and_awkward_text_is_quoted() {
        let text = text(&[], &[awkward()]);
        assert!(text.contains(",NaN,0.125,NaN,"), "{text}");
        assert!(text.contains("\"#1, \"\"quoted\"\"\""), "{text}");
        assert!(text.contains("\"two\nlines\""), "{text}");
    }

    #[test]
    fn what_was_written_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.csv");
        write_csv(&path, &[("command", "compare --size\n512")], &[awkward(), Row::default()]).unwrap();
        assert!(std::fs::read_to_string(&path).unwrap().starts_with("# command: compare --size 512\nscene,"));
        let back = read_csv(&path).unwrap();
        assert_eq!(back.len(), 2);
        assert_eq!((&back[0].scene, &back[0].technique), (&awkward().scene, &awkward().technique));
        assert_eq!(back[0].left_out, awkward().left_out);
        assert_eq!((back[0].mae.to_bits(), back[0].rmse.is_nan()), (0.125_f64.to_bits(), true));
        assert!(back[1].failed() && back[1].left_out.is_empty());
    }

    #[test]
    fn more_columns_come_last_and_are_read_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wide.csv");
        let rows = [(awkward(), vec![1.5, 2.5]), (Row::default(), vec![f64::NAN, 0.0])];
        write_wide_csv(&path, &[], &["low", "high"], &rows).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.lines().next().unwrap().ends_with(",left_out,low,high"), "{text}");
        assert!(text.contains(",1.5,2.5\n") && text.ends_with(",NaN,0.0\n"), "{text}");
        assert_eq!(read_csv(&path).unwrap().len(), 2);
        // A row that is too short spoils the table: nothing is written.
        let short = folder.path().join("short.csv");
        assert!(write_wide_csv(&short, &[], &["low", "high"], &[(awkward(), vec![1.5])]).is_err() && !short.exists());
    }

    #[test]
    fn a_cell_of_the_wrong_kind_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bad.csv");
        let good = text(&[], &[Row { mae: 0.125, ..Row::default() }]);
        std::fs::write(&path, good.replace("0.125", "much")).unwrap();
        let error = read_csv(&path).unwrap_err().to_string();
        assert!(error.contains("bad.csv") && error.contains("line: 2") && !error.contains('\n'), "{error}");
    }
}
