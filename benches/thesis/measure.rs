//! Photographs, and what each is worth.

use std::collections::HashMap;

use antumbra::lab::case::Case;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::cpu::Visible;
use antumbra::lab::experiment::{Backend, Shot, Studio};
use antumbra::lab::footprint::Measured;
use antumbra::lab::statistics::quantile;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::{CacheUse, Truth, TruthCache};
use antumbra::{Light, Remix};

use crate::artefacts::Artefacts;
use crate::programme::{Named, Programme, SHOWN, STEP_SIDE, Step, main_techniques, six, steps};

/// Times of one picture, milliseconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Times {
    pub(crate) fit: f64,
    pub(crate) casters: f64,
    pub(crate) filter: f64,
    pub(crate) receivers: f64,
}

impl Times {
    pub(crate) fn of(shot: &Shot) -> Self {
        let Shot { fit_ns, casters_ms, filter_ms, receivers_ms, .. } = *shot;
        Self { fit: fit_ns * 1e-6, casters: casters_ms, filter: filter_ms, receivers: receivers_ms }
    }

    pub(crate) fn total(&self) -> f64 {
        self.fit + self.casters + self.filter + self.receivers
    }

    /// By name, in the order in which they are done.
    pub(crate) fn passes(&self) -> [(&'static str, f64); 4] {
        [("fit", self.fit), ("casters", self.casters), ("filter", self.filter), ("receivers", self.receivers)]
    }

    /// Pass by pass.
    pub(crate) fn median(all: &[Self]) -> Self {
        let of = |pass: fn(&Self) -> f64| quantile(&all.iter().map(pass).collect::<Vec<_>>(), 0.5);
        Self {
            fit: of(|t| t.fit),
            casters: of(|t| t.casters),
            filter: of(|t| t.filter),
            receivers: of(|t| t.receivers),
        }
    }
}

/// One picture.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) shared: bool,
    pub(crate) scene: String,
    pub(crate) case: String,
    pub(crate) size: u32,
    pub(crate) name: &'static str,
    /// Maps that were drawn.
    pub(crate) maps: usize,
    pub(crate) mae: f64,
    pub(crate) excess: f64,
    pub(crate) rmse: f64,
    /// What a perfect hard-edged mask has: root mean square, mean.
    pub(crate) floor: [f64; 2],
    pub(crate) wrong: f64,
    /// Wrong pixels of the near, middle and far third.
    pub(crate) thirds: [f64; 3],
    pub(crate) edge_px: f64,
    pub(crate) leak: f64,
    pub(crate) acne: f64,
    pub(crate) times: Times,
    pub(crate) bytes: u64,
    /// Of the smallest maps on the thesis's scenes alone.
    pub(crate) artefacts: Option<Artefacts>,
}

/// Everything that was measured.
#[derive(Default)]
pub(crate) struct Results {
    pub(crate) records: Vec<Record>,
    /// Medians by scene, size and technique.
    pub(crate) timed: Vec<(&'static str, u32, &'static str, Times)>,
    /// Pictures of the visibility of the light, by scene/case, size and technique.
    pub(crate) masks: HashMap<(String, u32, &'static str), Vec<u8>>,
    /// Truths that no earlier run had left.
    pub(crate) traced: usize,
}

impl Results {
    pub(crate) fn truth(&mut self, assignment: &Assignment, case: &Case) -> Truth {
        let (truth, cache_use) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
        self.traced += usize::from(cache_use != CacheUse::Read);
        truth
    }
}

/// A technique in the formats of the backend.
pub(crate) fn adapted(backend: &Backend, techniques: Vec<Named>) -> Vec<Named> {
    techniques.into_iter().map(|(name, remix)| (name, backend.adapted(&remix))).collect()
}

/// A scene's name and a case's.
pub(crate) fn called(assignment: &Assignment, case: &Case) -> String {
    format!("{}/{}", assignment.scene, case.name)
}

/// Photographs the thesis's scenes: the main table, and the ablation at its one size.
pub(crate) fn built_in(backend: &mut Backend, programme: &Programme, results: &mut Results) -> Result<(), String> {
    let techniques = adapted(backend, main_techniques());
    let known = |step: &Step| techniques.iter().any(|(name, _)| *name == step.name);
    let further: Vec<Named> =
        steps().into_iter().filter(|step| !known(step)).map(|step| (step.name, step.remix)).collect();
    let further = adapted(backend, further);
    for assignment in programme.built_in()? {
        for case in &assignment.cases {
            let mut scenery = Scenery::new(backend, &assignment, case, false, results)?;
            for &size in programme.sizes() {
                let repetitions = if size == STEP_SIDE { programme.repetitions() } else { 1 };
                let how = How { size, repetitions, closely: size == programme.sizes()[0] };
                scenery.photograph(&techniques, how, results)?;
            }
            let how = How { size: STEP_SIDE, repetitions: programme.repetitions(), closely: false };
            scenery.photograph(&further, how, results)?;
        }
    }
    Ok(())
}

/// Photographs the shared cases.
pub(crate) fn shared(backend: &mut Backend, programme: &Programme, results: &mut Results) -> Result<(), String> {
    let techniques = adapted(backend, six());
    for assignment in programme.shared()? {
        for case in &assignment.cases {
            let mut scenery = Scenery::new(backend, &assignment, case, true, results)?;
            for &size in programme.sizes() {
                scenery.photograph(&techniques, How { size, repetitions: 1, closely: false }, results)?;
            }
        }
    }
    Ok(())
}

/// How pictures of a case are taken.
#[derive(Clone, Copy)]
struct How {
    /// Side of maps, texels.
    size: u32,
    /// Turns of each pass; medians are kept.
    repetitions: u32,
    /// Whether artefacts are measured.
    closely: bool,
}

/// A case with its truth, ready to be photographed.
struct Scenery<'a> {
    studio: Studio<'a>,
    setting: Setting,
    visible: Visible,
    truth: Truth,
    shared: bool,
    scene: String,
    case: String,
}

impl<'a> Scenery<'a> {
    fn new(
        backend: &'a mut Backend,
        assignment: &'a Assignment,
        case: &Case,
        shared: bool,
        results: &mut Results,
    ) -> Result<Self, String> {
        let truth = results.truth(assignment, case);
        let setting = Setting::of(case);
        let visible = Visible::draw(&assignment.subject.model, &setting.camera, setting.origin);
        let studio = Studio::new(backend, &assignment.subject, setting).map_err(|error| error.to_string())?;
        let (scene, case) = (assignment.scene.clone(), case.name.clone());
        Ok(Self { studio, setting, visible, truth, shared, scene, case })
    }

    /// Adds a record of each technique, and keeps the masks that may be shown.
    fn photograph(&mut self, all: &[Named], how: How, results: &mut Results) -> Result<(), String> {
        let size = how.size;
        for (name, remix) in all {
            let (record, mask) = self.shoot(name, remix, how)?;
            println!(
                "{}/{} {size} {name}: excess {:.3} %, wrong {:.3} %, {:.0} ms",
                record.scene,
                record.case,
                100.0 * record.excess,
                100.0 * record.wrong,
                record.times.total()
            );
            if !self.shared && main_techniques().iter().any(|(known, _)| known == name) {
                results.masks.insert((format!("{}/{}", self.scene, self.case), size, name), mask);
            }
            results.records.push(record);
        }
        Ok(())
    }

    fn shoot(&mut self, name: &'static str, remix: &Remix, how: How) -> Result<(Record, Vec<u8>), String> {
        let shot = self.studio.shoot(remix, how.size, how.repetitions).map_err(|error| error.to_string())?;
        let scores = shot.scores(&self.truth).map_err(|error| error.to_string())?;
        let artefacts = how.closely.then(|| {
            let footprints = Measured::new(&self.visible, &shot.frame, &self.setting, &self.truth.valid);
            let Light::Directional { travel } = self.setting.light else { return Artefacts::default() };
            Artefacts::of(&shot.mask, &self.truth, travel, footprints.perspective)
        });
        let record = Record {
            shared: self.shared,
            scene: self.scene.clone(),
            case: self.case.clone(),
            size: how.size,
            name,
            maps: shot.frame.views.len(),
            mae: scores.mae,
            excess: scores.excess,
            rmse: scores.rmse,
            floor: [scores.floor_rmse, scores.floor_mae],
            wrong: scores.wrong_center,
            thirds: scores.thirds.map(|third| third.wrong_center),
            edge_px: scores.edge_center_px.unwrap_or(f64::NAN),
            leak: scores.leak_interior,
            acne: scores.false_interior,
            times: Times::of(&shot),
            bytes: shot.bytes,
            artefacts,
        };
        Ok((record, shot.mask))
    }
}

/// Times the six where the thesis has its pictures, turn by turn, so that other work on the machine meets all of them.
pub(crate) fn time(backend: &mut Backend, programme: &Programme, results: &mut Results) -> Result<(), String> {
    let techniques = adapted(backend, six());
    for (scene, viewpoint) in SHOWN {
        for assignment in programme.built_in()?.iter().filter(|assignment| assignment.scene == scene) {
            let Some(case) = assignment.cases.iter().find(|case| case.name == viewpoint) else { continue };
            let mut studio =
                Studio::new(backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
            for &size in programme.sizes() {
                let mut times = vec![Vec::new(); techniques.len()];
                for _ in 0..programme.turns() {
                    for ((_, remix), times) in techniques.iter().zip(&mut times) {
                        let shot =
                            studio.shoot(remix, size, programme.repetitions()).map_err(|error| error.to_string())?;
                        times.push(Times::of(&shot));
                    }
                }
                for ((name, _), times) in techniques.iter().zip(&times) {
                    results.timed.push((scene, size, name, Times::median(times)));
                }
                println!("{scene}/{viewpoint} {size}: timed");
            }
        }
    }
    Ok(())
}
