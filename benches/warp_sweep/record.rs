//! What was measured, and the table it is kept in.

use std::fmt::Write as _;
use std::path::Path;

use antumbra::lab::files::write_whole;

/// One picture of one case.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    /// `shared`, `tour` or `built-in`.
    pub(crate) set: String,
    pub(crate) scene: String,
    pub(crate) case: String,
    /// Side of the map, texels.
    pub(crate) size: u32,
    /// κλ that was asked for, or the name of a technique.
    pub(crate) strength: String,
    /// κλ that the map has.
    pub(crate) applied: f64,
    /// What the fit predicted.
    pub(crate) predicted: f64,
    /// Share of the pixels that are wrong, 0 to 1; NaN where the run failed.
    pub(crate) wrong: f64,
    /// The same of the near, the middle and the far third.
    pub(crate) thirds: [f64; 3],
    /// False shadow away from edges, share of the pixels.
    pub(crate) acne: f64,
    /// False light away from edges, share of the pixels.
    pub(crate) leak: f64,
}

const HEADER: &str = "set,scene,case,size,strength,applied,predicted,wrong,near,mid,far,acne,leak";

/// Everything that was measured, and with what.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    pub(crate) meta: Vec<(String, String)>,
    pub(crate) records: Vec<Record>,
}

impl Sweep {
    pub(crate) fn write(&self, path: &Path) -> Result<(), String> {
        let mut text = String::new();
        for (name, value) in &self.meta {
            let _ = writeln!(text, "# {name}: {value}");
        }
        let _ = writeln!(text, "{HEADER}");
        for record in &self.records {
            let Record { set, scene, case, size, strength, applied, predicted, wrong, thirds, acne, leak } = record;
            let [near, mid, far] = thirds;
            let _ = writeln!(
                text,
                "{set},{scene},{case},{size},{strength},{applied},{predicted},{wrong},{near},{mid},{far},{acne},{leak}"
            );
        }
        write_whole(path, text.as_bytes())
    }

    pub(crate) fn read(path: &Path) -> Result<Self, String> {
        let text =
            std::fs::read_to_string(path).map_err(|error| format!("{}: {error}; sweep first", path.display()))?;
        let mut sweep = Self::default();
        for (number, line) in text.lines().enumerate() {
            if let Some(meta) = line.strip_prefix("# ") {
                sweep.meta.extend(meta.split_once(": ").map(|(name, value)| (name.to_owned(), value.to_owned())));
            } else if line != HEADER {
                let record = Record::parse(line);
                sweep.records.push(
                    record.ok_or_else(|| format!("{}:{}: \"{line}\"; legal: {HEADER}", path.display(), number + 1))?,
                );
            }
        }
        Ok(sweep)
    }
}

impl Record {
    fn parse(line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let [set, scene, case, size, strength, numbers @ ..] = fields.as_slice() else { return None };
        let numbers: Vec<f64> = numbers.iter().map(|number| number.parse().ok()).collect::<Option<_>>()?;
        let [applied, predicted, wrong, near, mid, far, acne, leak] = *numbers.as_slice() else { return None };
        let [set, scene, case, strength] = [set, scene, case, strength].map(|text| (*text).to_owned());
        let thirds = [near, mid, far];
        Some(Self {
            set,
            scene,
            case,
            size: size.parse().ok()?,
            strength,
            applied,
            predicted,
            wrong,
            thirds,
            acne,
            leak,
        })
    }
}
