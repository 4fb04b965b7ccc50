//! Photographs every contender of a case and a size in turns, and races the library against passes by hand.

use std::time::Instant;

use antumbra::lab::case::Case;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::experiment::{Backend, RunError, Studio, Timed, stage_names};
use antumbra::lab::gpu::Race;
use antumbra::lab::report::Row;
use antumbra::lab::statistics::quantile;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{ShadowTechnique, techniques};

use crate::contenders::{Contender, LARGE, NINE_TAPS, SIZES, takes_part};

/// A run this wrong drew something else than shadows: it is reported as failed, not timed as if it had worked.
pub(crate) const WORST_WRONG: f64 = 0.25;

/// Side of the map of a race, texels: the passes' ratios hardly change with it.
pub(crate) const RACE_SIZE: u32 = 1024;

/// How much is measured.
#[derive(Clone, Debug)]
pub(crate) struct Effort {
    pub(crate) sizes: Vec<u32>,
    /// Turns of the contenders.
    pub(crate) turns: u32,
    /// Turns of the comparison with nine comparisons, and those of maps of [`LARGE`] texels and more.
    pub(crate) nine_turns: [u32; 2],
    /// Turns of a race: its medians are ratios of neighbours in time.
    pub(crate) race_turns: u32,
}

impl Effort {
    /// Turn by turn, and apart from all others, filter and receivers of `smra-plus` over those with nine comparisons;
    /// medians, NaN where one of them failed.
    fn nine_taps(&self, studio: &mut Studio, contenders: &[Contender], size: u32) -> [f64; 2] {
        let [of_same, of_one] = NINE_TAPS;
        // Each beside its yardstick.
        let names = [of_same, "smra-plus", of_one];
        let found = names.map(|name| contenders.iter().find(|contender| contender.name == name));
        let drawn: Vec<&dyn ShadowTechnique> = found.iter().flatten().map(|contender| &contender.remix as _).collect();
        let timed = studio.shoot_in_turns(&drawn, size, self.nine_turns[usize::from(size >= LARGE)]);
        let [Ok(of_same), Ok(ours), Ok(of_one)] = &timed[..] else { return [f64::NAN; 2] };
        let ms = |[_, filter, receivers]: &[f64; 3]| filter + receivers;
        [of_same, of_one].map(|theirs| {
            let turns = ours.passes.iter().zip(&theirs.passes);
            quantile(&turns.map(|(ours, theirs)| ms(ours) / ms(theirs)).collect::<Vec<_>>(), 0.5)
        })
    }
}

/// One run.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) row: Row,
    /// Quartiles of the time of a frame over the turns, milliseconds.
    pub(crate) quartiles: [f64; 2],
}

/// Receivers and filter of the technique that is measured by it, over receivers with nine comparisons.
#[derive(Clone, Debug)]
pub(crate) struct NineTaps {
    pub(crate) case: String,
    pub(crate) size: u32,
    /// Median over turns, in the order of [`NINE_TAPS`].
    pub(crate) ratios: [f64; 2],
}

/// What one set of cases gave.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    /// `shared`, or the scene.
    pub(crate) set: String,
    pub(crate) records: Vec<Record>,
    pub(crate) races: Vec<(String, Race)>,
    pub(crate) nine_taps: Vec<NineTaps>,
}

/// Name of the set of case files.
pub(crate) const SHARED: &str = "shared";

/// The built-in scenes, and the case files beside the folder of `ANTUMBRA_SCENES`, by the name of their set; only the
/// cases whose name contains `only`, at most so many of each set.
pub(crate) fn sets(only: Option<&str>, most: usize) -> Result<Vec<(String, Vec<Assignment>)>, String> {
    let mut sets = Vec::new();
    for scene in ["treeline", "sparse-city"] {
        sets.push((scene.to_owned(), vec![Assignment::of_scene(scene)?]));
    }
    sets.push((SHARED.to_owned(), Assignment::shared()?));
    for (set, assignments) in &mut sets {
        let mut left = most;
        for assignment in &mut *assignments {
            assignment.cases.retain(|case| only.is_none_or(|only| format!("{set}/{}", case.name).contains(only)));
            assignment.cases.truncate(left);
            left -= assignment.cases.len();
        }
        assignments.retain(|assignment| !assignment.cases.is_empty());
    }
    sets.retain(|(_, assignments)| !assignments.is_empty());
    Ok(sets)
}

/// Who draws what, and how often.
pub(crate) struct Session<'a> {
    pub(crate) backend: &'a mut Backend,
    pub(crate) contenders: &'a [Contender],
    pub(crate) effort: &'a Effort,
}

impl Session<'_> {
    /// Measures all cases of a set.
    pub(crate) fn measure(&mut self, set: &str, assignments: &[Assignment]) -> Result<Measured, String> {
        let mut measured =
            Measured { set: set.to_owned(), records: Vec::new(), races: Vec::new(), nine_taps: Vec::new() };
        for assignment in assignments {
            for case in &assignment.cases {
                let start = Instant::now();
                let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
                for &size in &self.effort.sizes {
                    let (records, ratios) = self.shoot(assignment, case, &truth, size)?;
                    measured.records.extend(records);
                    measured.nine_taps.extend(ratios);
                }
                measured.races.extend(self.race(assignment, case)?.map(|race| (case.name.clone(), race)));
                println!("{set}/{}: {:.0} s", case.name, start.elapsed().as_secs_f64());
            }
        }
        Ok(measured)
    }

    /// All contenders of one case and size.
    fn shoot(
        &mut self,
        assignment: &Assignment,
        case: &Case,
        truth: &Truth,
        size: u32,
    ) -> Result<(Vec<Record>, Option<NineTaps>), String> {
        let (name, adapter) = (self.backend.name().to_owned(), self.backend.adapter());
        let mut studio =
            Studio::new(self.backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
        let present: Vec<&Contender> = self.contenders.iter().filter(|contender| takes_part(contender, size)).collect();
        let drawn: Vec<&dyn ShadowTechnique> = present.iter().map(|contender| &contender.remix as _).collect();
        let timed = studio.shoot_in_turns(&drawn, size, self.effort.turns);
        let ratios = SIZES.contains(&size).then(|| NineTaps {
            case: case.name.clone(),
            size,
            ratios: self.effort.nine_taps(&mut studio, self.contenders, size),
        });
        let row = |contender: &Contender| {
            let [split, warp, encoding] = stage_names(&contender.remix);
            let (scene, case, technique) = (assignment.scene.clone(), case.name.clone(), contender.name.clone());
            let (backend, adapter) = (name.clone(), adapter.clone());
            Row { scene, case, technique, split, warp, encoding, size, backend, adapter, ..Row::default() }
        };
        let records =
            present.iter().zip(timed).map(|(contender, timed)| record(row(contender), timed, truth)).collect();
        Ok((records, ratios))
    }

    /// The library's passes beside those by hand.
    fn race(&mut self, assignment: &Assignment, case: &Case) -> Result<Option<Race>, String> {
        let mut studio =
            Studio::new(self.backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
        studio.race(&techniques::fsm(), RACE_SIZE, self.effort.race_turns).map_err(|error| error.to_string())
    }
}

/// A row with what was measured; one that failed, or whose picture is none of shadows, says so.
fn record(mut row: Row, timed: Result<Timed, RunError>, truth: &Truth) -> Record {
    let failed = |row: Row, why: String| Record { row: Row { left_out: vec![why], ..row }, quartiles: [f64::NAN; 2] };
    let blank = row.clone();
    let scored = timed.and_then(|timed| timed.shot.scores(truth).map(|scores| (timed, scores)));
    let (timed, scores) = match scored {
        Ok(scored) => scored,
        Err(error) => return failed(blank, error.to_string()),
    };
    timed.shot.fill(&mut row, &scores);
    if row.wrong_center >= WORST_WRONG {
        let why = format!("verification: {:.0} % of the pixels are wrong", 100.0 * row.wrong_center);
        return failed(blank, why);
    }
    let totals: Vec<f64> = timed.passes.iter().map(|turn| 1e-6 * row.fit_ns + turn.iter().sum::<f64>()).collect();
    row.total_ms = quantile(&totals, 0.5);
    Record { row, quartiles: [0.25, 0.75].map(|share| quantile(&totals, share)) }
}
