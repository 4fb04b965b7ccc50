//! The manual's table of techniques, which is written by this test out of `docs/work_precision.csv` and must be what it
//! would write: `ANTUMBRA_WRITE=1 cargo test --test manual`.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

use antumbra::lab::statistics::{mean, quantile};
use antumbra::techniques;

/// Side of the maps of the table, texels.
const SIDE: &str = "1024";

/// Bytes of a MiB.
const MEBI: f64 = 1_048_576.0;

/// Between these lines of the manual stands the table.
const BEGIN: &str = "<!-- table of techniques: begin -->\n";
const END: &str = "<!-- table of techniques: end -->\n";

/// What each technique is, and when to take it.
const ABOUT: [(&str, &str); 18] = [
    (
        "ssm",
        "one standard map, uniform over the whole scene (Williams 1978). Still scenes: it does not depend on the camera",
    ),
    ("fsm", "one focused map, uniform over what is in view (Brabec et al. 2002). The yardstick; views along the light"),
    ("psm", "one perspective map: as the light sees the camera's post-perspective space (Stamminger & Drettakis 2002)"),
    ("tsm", "one trapezoidal map: 80 % of it for the first part of what is in view (Martin & Tan 2004)"),
    ("lispsm", "one light-space perspective map: equal errors at both ends (Wimmer et al. 2004)"),
    (
        "minimax",
        "one map, warped for the least worst footprint (after Lloyd et al. 2008). When one bad pixel is too many",
    ),
    (
        "least-error",
        "one map, warped by the strength and the direction of least predicted picture error. **The one map to take**",
    ),
    ("pssm", "3 maps: parallel splits, λ = ½, by depth, no warp (Zhang et al. 2006)"),
    (
        "cascades",
        "4 maps: splits of equal predicted error, the finest map that holds a point, least-error warps. Large scenes",
    ),
    ("vsm", "one focused map of two moments, variance (Donnelly & Lauritzen 2006): bleeds where casters overlap"),
    ("esm", "one focused exponential map (Annen et al. 2008): leaks at contacts"),
    ("convolution", "one focused map of a Fourier series of 8 terms (Annen et al. 2007): rings, and is dear"),
    ("evsm", "one focused map, variance of two exponentials (Lauritzen & McCool 2008). Soft shadows of constant width"),
    ("evsm-two", "the same, first exponential alone: half the memory, leaks at contacts"),
    ("msm", "one focused map of four moments (Peters & Klein 2015). Soft shadows of constant width"),
    ("msm-hausdorff", "the same, for depths known to be within the map: where a few more operations are free"),
    (
        "smra",
        "3 maps: the remix of the thesis, parallel splits × trapezoidal × variance × ½ where light grazes (Abrantes de Oliveira)",
    ),
    (
        "smra-plus",
        "4 maps: the same remix of what measurements justify, splits of equal error, the finest map, no warps, four samples \
         over the pixel. **Least mean error**",
    ),
];

/// A column of the table by its name in the file, for one technique over all pictures.
struct Results {
    header: csv::StringRecord,
    rows: Vec<csv::StringRecord>,
}

impl Results {
    fn read(path: &Path) -> Self {
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).expect("the table is there");
        let header = reader.headers().expect("a header").clone();
        Self { header, rows: reader.records().map(|row| row.expect("a row")).collect() }
    }

    fn field<'a>(&self, row: &'a csv::StringRecord, name: &str) -> &'a str {
        let column = self.header.iter().position(|column| column == name).expect("a column of that name");
        &row[column]
    }

    fn of(&self, technique: &str, name: &str) -> Vec<f64> {
        let here =
            |row: &&csv::StringRecord| self.field(row, "technique") == technique && self.field(row, "size") == SIDE;
        let number = |row| self.field(row, name).parse().unwrap_or(f64::NAN);
        self.rows.iter().filter(here).map(number).collect()
    }
}

fn table() -> String {
    let results = Results::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/work_precision.csv"));
    let mut text = "| name | what it is, and when | mean error, % | wrong, % | leak, % | time, ms | memory, MiB |\n\
                    |---|---|--:|--:|--:|--:|--:|\n"
        .to_owned();
    let named: Vec<&str> = techniques::NAMED.iter().map(|(name, _)| *name).collect();
    assert_eq!(named.len(), ABOUT.len(), "a technique is missing");
    for (name, about) in ABOUT {
        assert!(named.contains(&name), "{name}");
        let of = |column| results.of(name, column);
        let percent = |column| 100.0 * mean(&of(column));
        let _ = writeln!(
            text,
            "| `{name}` | {about} | {:.2} | {:.2} | {:.3} | {:.0} | {:.0} |",
            percent("mae"),
            percent("wrong_center"),
            percent("leak_interior"),
            quantile(&of("total_ms"), 0.5),
            mean(&of("bytes")) / MEBI
        );
    }
    text
}

#[test]
fn the_table_of_techniques_is_what_was_measured() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let manual = fs::read_to_string(&path).expect("the manual is there");
    let (before, rest) = manual.split_once(BEGIN).expect("the table begins");
    let (found, after) = rest.split_once(END).expect("the table ends");
    let expected = table();
    if env::var_os("ANTUMBRA_WRITE").is_some() {
        fs::write(&path, [before, BEGIN, &expected, END, after].concat()).expect("the manual can be written");
    } else {
        assert_eq!(found, expected, "the table is out of date: ANTUMBRA_WRITE=1 cargo test --test manual");
    }
    assert!(!expected.contains("NaN"), "{expected}");
}
