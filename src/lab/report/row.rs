//! One measured point: the unit of the CSV file, the report's tables and the plots.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Stands between the entries of [`Row::left_out`] inside one CSV cell, so that a row stays on one line.
const LEFT_OUT_SEPARATOR: &str = " | ";

/// One technique, on one case, with one map size: what it cost and how far its picture is from the truth.
///
/// The fields are the columns of `results.csv`, in order. A failed run is a row too: its figures are NaN and
/// [`left_out`](Row::left_out) holds the error. The default is a row on which nothing was measured: figures NaN,
/// counts 0.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Scene: a built-in name or the stem of the file it came from.
    pub scene: String,
    /// Case: the name of the camera and light within the scene.
    pub case: String,
    /// Technique as named on the command line.
    pub technique: String,
    /// Split stage: how many maps, and where they part.
    pub split: String,
    /// Warp stage: how texels are spread within a map.
    pub warp: String,
    /// Encoding stage: what a texel stores and how it is filtered.
    pub encoding: String,
    /// Side of one map asked for, texels.
    pub size: u32,
    /// Views (maps) that were drawn; 0 when the run failed before drawing.
    pub views: u32,
    /// Texels of all views together.
    pub texels: u64,
    /// Map memory, bytes, filtered copies included.
    pub bytes: u64,
    /// Renderer that ran: `gpu` or `cpu`.
    pub backend: String,
    /// Adapter (or processor) that ran it, by the name it gives itself.
    pub adapter: String,
    /// Time of one fit on the CPU, nanoseconds (> 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub fit_ns: f64,
    /// Time to draw the casters into the maps, milliseconds (>= 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub casters_ms: f64,
    /// Time to filter the maps, milliseconds (>= 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub filter_ms: f64,
    /// Time to shade the receivers, milliseconds (>= 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub receivers_ms: f64,
    /// Time of the whole frame, milliseconds (> 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub total_ms: f64,
    /// Root of the mean squared difference from the area truth, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub rmse: f64,
    /// Mean absolute difference from the area truth, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub mae: f64,
    /// What `mae` a perfect lookup with one sample per pixel has here, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub floor_mae: f64,
    /// Share of the valid pixels more than one half away from the area truth, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub wrong: f64,
    /// Share of the valid pixels more than one half away from the centre truth, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub wrong_center: f64,
    /// Displacement of the shadow edges that lie on one surface, against the centre truth, screen pixels (>= 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub edge_center_px: f64,
    /// Light where there is none, within 2 px of an edge of the true shadow, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub leak_edge: f64,
    /// Light where there is none, further inside the true shadow (bleeding), 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub leak_interior: f64,
    /// Shadow where there is none, within 2 px of an edge of the true shadow, 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub false_edge: f64,
    /// Shadow where there is none, further out in the light (acne), 0..1.
    #[serde(deserialize_with = "nan_when_absent")]
    pub false_interior: f64,
    /// Footprint that the fit predicted, screen pixels per texel (> 0).
    #[serde(deserialize_with = "nan_when_absent")]
    pub predicted_px: f64,
    /// Everything that the technique left out, clamped or fell back from, one entry each, verbatim;
    /// the error of a failed run.
    #[serde(serialize_with = "join_entries", deserialize_with = "split_entries")]
    pub left_out: Vec<String>,
}

impl Default for Row {
    fn default() -> Self {
        let text = String::new;
        Self {
            scene: text(),
            case: text(),
            technique: text(),
            split: text(),
            warp: text(),
            encoding: text(),
            size: 0,
            views: 0,
            texels: 0,
            bytes: 0,
            backend: text(),
            adapter: text(),
            fit_ns: f64::NAN,
            casters_ms: f64::NAN,
            filter_ms: f64::NAN,
            receivers_ms: f64::NAN,
            total_ms: f64::NAN,
            rmse: f64::NAN,
            mae: f64::NAN,
            floor_mae: f64::NAN,
            wrong: f64::NAN,
            wrong_center: f64::NAN,
            edge_center_px: f64::NAN,
            leak_edge: f64::NAN,
            leak_interior: f64::NAN,
            false_edge: f64::NAN,
            false_interior: f64::NAN,
            predicted_px: f64::NAN,
            left_out: Vec::new(),
        }
    }
}

impl Row {
    /// Whether the run failed: not one error against a truth was measured.
    #[must_use]
    pub fn failed(&self) -> bool {
        [self.rmse, self.mae, self.wrong, self.wrong_center].iter().all(|figure| figure.is_nan())
    }

    /// Mean absolute error above the floor (`mae - floor_mae`): the figure for filtered techniques. Slightly negative
    /// when filtering beats a perfect single sample.
    #[must_use]
    pub fn excess(&self) -> f64 {
        self.mae - self.floor_mae
    }
}

/// Reads a figure; a JSON `null` or an empty CSV cell is NaN, because JSON has no way to write NaN.
fn nan_when_absent<'de, D: Deserializer<'de>>(source: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(source)?.unwrap_or(f64::NAN))
}

/// Writes the entries as one text.
fn join_entries<S: Serializer>(entries: &[String], sink: S) -> Result<S::Ok, S::Error> {
    sink.serialize_str(&entries.join(LEFT_OUT_SEPARATOR))
}

/// Reads the entries back from one text.
fn split_entries<'de, D: Deserializer<'de>>(source: D) -> Result<Vec<String>, D::Error> {
    let text = String::deserialize(source)?;
    Ok(text.split(LEFT_OUT_SEPARATOR).filter(|entry| !entry.is_empty()).map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_on_which_nothing_was_measured_never_looks_perfect() {
        let row = Row::default();
        assert!(row.failed());
        assert!(row.excess().is_nan());
        assert!(row.fit_ns.is_nan() && row.total_ms.is_nan() && row.predicted_px.is_nan());
    }

    #[test]
    fn json_carries_nan_as_null_and_back() {
        let row = Row { mae: 0.25, left_out: vec!["view 3: empty".into(), "warp: off".into()], ..Row::default() };
        let text = serde_json::to_string(&row).unwrap();
        let back: Row = serde_json::from_str(&text).unwrap();
        assert!(text.contains("\"rmse\":null"));
        assert!(back.rmse.is_nan() && !back.failed());
        assert_eq!(back.mae.to_bits(), 0.25_f64.to_bits());
        assert_eq!(back.left_out, row.left_out);
    }
}
