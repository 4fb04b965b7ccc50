//! What is swept, and the sweep itself.

use std::fmt::Write as _;

use antumbra::lab::case::Case;
use antumbra::lab::comparison::{Assignment, shared_scenes};
use antumbra::lab::experiment::{Backend, RunError, Studio};
use antumbra::lab::files::with_extension;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{Remix, Warp, techniques};

use crate::record::{Record, Sweep};

/// Sides of maps, texels.
const SIZES: [u32; 4] = [256, 512, 1024, 2048];
/// Sides of maps of a quick sweep, texels.
const QUICK_SIZES: [u32; 2] = [512, 2048];
/// A quick sweep looks at every so many-th case.
const QUICK_STEP: usize = 4;
/// κλ: from none to more than any picture has wanted.
pub(crate) const STRENGTHS: [f32; 16] =
    [0.0, 0.15, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 45.0, 60.0];

/// Techniques beside the sweep: as they are called here, by name, and whether the guard is on.
pub(crate) const NAMED: [(&str, &str, bool); 10] = [
    ("fsm", "fsm", true),
    ("psm unguarded", "psm", false),
    ("psm", "psm", true),
    ("tsm unguarded", "tsm", false),
    ("tsm", "tsm", true),
    ("lispsm unguarded", "lispsm", false),
    ("lispsm", "lispsm", true),
    ("minimax unguarded", "minimax", false),
    ("minimax", "minimax", true),
    ("least-error", "least-error", true),
];

/// Which cases at which sizes.
pub(crate) struct Programme {
    quick: bool,
    only: Option<String>,
}

impl Programme {
    pub(crate) fn new(quick: bool, only: Option<String>) -> Self {
        Self { quick, only }
    }

    /// The arguments that ask for this.
    pub(crate) fn arguments(&self) -> Vec<&str> {
        self.quick.then_some("--quick").into_iter().chain(self.only.as_deref()).collect()
    }

    fn sizes(&self) -> &'static [u32] {
        if self.quick { &QUICK_SIZES } else { &SIZES }
    }

    /// Sets, scenes and the cases of them that are swept.
    pub(crate) fn assignments(&self) -> Result<Vec<(&'static str, Assignment)>, String> {
        let mut assignments: Vec<_> = Assignment::shared()?.into_iter().map(|of| ("shared", of)).collect();
        if let Some(scenes) = shared_scenes() {
            for path in with_extension(&scenes, "glb")? {
                assignments.push(("tour", Assignment::of_scene(&path.display().to_string())?));
            }
        }
        for scene in ["treeline", "sparse-city"] {
            assignments.push(("built-in", Assignment::of_scene(scene)?));
        }
        let mut index = 0;
        for (set, assignment) in &mut assignments {
            let scene = assignment.scene.clone();
            assignment.cases.retain(|case| {
                index += 1;
                let name = format!("{set}/{scene}/{}", case.name);
                let wanted = self.only.as_ref().is_none_or(|only| name.contains(only.as_str()));
                wanted && (!self.quick || index % QUICK_STEP == 1)
            });
        }
        assignments.retain(|(_, assignment)| !assignment.cases.is_empty());
        Ok(assignments)
    }
}

/// Photographs every case of an assignment at every size with every strength and technique.
pub(crate) fn sweep(
    backend: &mut Backend,
    programme: &Programme,
    set: &str,
    assignment: &Assignment,
    sweep: &mut Sweep,
) -> Result<(), String> {
    for case in &assignment.cases {
        let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
        let mut studio =
            Studio::new(backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
        for &size in programme.sizes() {
            let before = sweep.records.len();
            for (strength, remix) in remixes() {
                let blank = blank(set, assignment, case, size, &strength);
                sweep.records.push(photograph(&mut studio, &truth, &remix, &blank).unwrap_or_else(|error| {
                    println!("{}/{} {size} {strength}: {error}", assignment.scene, case.name);
                    blank
                }));
            }
            let mut wrong = String::new();
            for record in &sweep.records[before..] {
                let _ = write!(wrong, " {:.3}", 100.0 * record.wrong);
            }
            println!("{set}/{}/{} {size}:{wrong}", assignment.scene, case.name);
        }
    }
    Ok(())
}

/// Every strength and every technique, with what it is called in the table.
fn remixes() -> impl Iterator<Item = (String, Remix)> {
    let fixed =
        STRENGTHS.map(|strength| (strength.to_string(), Remix { warp: Warp::Fixed { strength }, ..Remix::default() }));
    let named = NAMED.map(|(called, name, guard)| {
        let warp = techniques::by_name(name).map_or(Warp::Focused, |remix| remix.warp);
        (called.to_owned(), Remix { warp, guard, ..Remix::default() })
    });
    fixed.into_iter().chain(named)
}

/// A run that gave no picture.
fn blank(set: &str, assignment: &Assignment, case: &Case, size: u32, strength: &str) -> Record {
    Record {
        set: set.to_owned(),
        scene: assignment.scene.clone(),
        case: case.name.clone(),
        size,
        strength: strength.to_owned(),
        applied: f64::NAN,
        predicted: f64::NAN,
        wrong: f64::NAN,
        thirds: [f64::NAN; 3],
        acne: f64::NAN,
        leak: f64::NAN,
    }
}

/// Draws one picture and compares it with the truth.
fn photograph(studio: &mut Studio, truth: &Truth, remix: &Remix, blank: &Record) -> Result<Record, RunError> {
    let shot = studio.shoot(remix, blank.size, 1)?;
    let scores = shot.scores(truth)?;
    Ok(Record {
        applied: shot.frame.views.first().map_or(0.0, |view| f64::from(view.warp_strength)),
        predicted: f64::from(shot.frame.predicted.error),
        wrong: scores.wrong_center,
        thirds: scores.thirds.map(|third| third.wrong_center),
        acne: scores.false_interior,
        leak: scores.leak_interior,
        ..blank.clone()
    })
}
