//! Photographs, and what each is worth.

use std::collections::HashMap;

use antumbra::lab::case::Case;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::cpu::Visible;
use antumbra::lab::experiment::{Backend, RunError, Shot, Studio, Timed};
use antumbra::lab::footprint::Measured;
use antumbra::lab::statistics::quantile;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::{CacheUse, Truth, TruthCache};
use antumbra::{Light, ShadowTechnique};

use crate::artefacts::Artefacts;
use crate::programme::{Named, Programme, SHOWN, STEP_SIDE, Step, main_techniques, shared_techniques, steps, wide};

/// Times of one picture, milliseconds: medians of turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    pub(crate) fit: f64,
    pub(crate) casters: f64,
    pub(crate) filter: f64,
    pub(crate) receivers: f64,
    /// Of the turns' own sums, and half the distance between their quartiles.
    pub(crate) total: f64,
    pub(crate) spread: f64,
    /// How many there were.
    pub(crate) turns: usize,
}

impl Times {
    fn of(timed: &Timed) -> Self {
        let Shot { fit_ns, casters_ms, filter_ms, receivers_ms, .. } = timed.shot;
        let fit = 1e-6 * fit_ns;
        let totals: Vec<f64> = timed.passes.iter().map(|turn| fit + turn.iter().sum::<f64>()).collect();
        let [low, total, high] = [0.25, 0.5, 0.75].map(|share| quantile(&totals, share));
        let (casters, filter, receivers) = (casters_ms, filter_ms, receivers_ms);
        Self { fit, casters, filter, receivers, total, spread: 0.5 * (high - low), turns: totals.len() }
    }

    /// By name, in the order in which they are done.
    pub(crate) fn passes(&self) -> [(&'static str, f64); 4] {
        [("fit", self.fit), ("casters", self.casters), ("filter", self.filter), ("receivers", self.receivers)]
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
    /// Displacement of edges, pixels; none where no edge can be followed.
    pub(crate) edge_px: Option<f64>,
    pub(crate) leak: f64,
    pub(crate) acne: f64,
    /// Where they are reported.
    pub(crate) times: Option<Times>,
    pub(crate) bytes: u64,
    /// Of the smallest maps on the thesis's scenes alone.
    pub(crate) artefacts: Option<Artefacts>,
}

/// Everything that was measured.
#[derive(Default)]
pub(crate) struct Results {
    pub(crate) records: Vec<Record>,
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

/// Photographs the thesis's scenes: the main table, and with it, at its one size, the ablation.
pub(crate) fn built_in(backend: &mut Backend, programme: &Programme, results: &mut Results) -> Result<(), String> {
    let techniques = adapted(backend, main_techniques());
    let known = |step: &Step| techniques.iter().any(|(name, _)| *name == step.name);
    let further = steps().into_iter().filter(|step| !known(step)).map(|step| (step.name, step.remix)).collect();
    let all: Vec<Named> = techniques.iter().copied().chain(adapted(backend, further)).collect();
    for assignment in programme.built_in()? {
        for case in &assignment.cases {
            let shown = SHOWN.contains(&(assignment.scene.as_str(), case.name.as_str()));
            let mut scenery = Scenery::new(backend, &assignment, case, false, results)?;
            for &size in programme.sizes() {
                let these = if size == STEP_SIDE { &all } else { &techniques };
                let how = How { size, turns: programme.turns(shown, size), closely: size == programme.sizes()[0] };
                scenery.photograph(these, how, results)?;
            }
            scenery.photograph(&wide(&techniques), How::untimed(programme.wide_size()), results)?;
        }
    }
    Ok(())
}

/// Photographs the shared cases.
pub(crate) fn shared(backend: &mut Backend, programme: &Programme, results: &mut Results) -> Result<(), String> {
    let techniques = adapted(backend, shared_techniques());
    for assignment in programme.shared()? {
        for case in &assignment.cases {
            let mut scenery = Scenery::new(backend, &assignment, case, true, results)?;
            for &size in programme.sizes() {
                scenery.photograph(&techniques, How::untimed(size), results)?;
            }
            scenery.photograph(&wide(&techniques), How::untimed(programme.wide_size()), results)?;
        }
    }
    Ok(())
}

/// How pictures of a case are taken.
#[derive(Clone, Copy)]
struct How {
    /// Side of maps, texels.
    size: u32,
    /// Timed turns; 0 draws once, untimed.
    turns: u32,
    /// Whether artefacts are measured.
    closely: bool,
}

impl How {
    fn untimed(size: u32) -> Self {
        Self { size, turns: 0, closely: false }
    }
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
        let shots = self.shoot(all, how)?;
        for ((name, _), (shot, times)) in all.iter().zip(shots) {
            let record = self.record(name, &shot, times, how)?;
            println!(
                "{}/{} {} {name}: excess {:.3} %, wrong {:.3} %{}",
                record.scene,
                record.case,
                how.size,
                100.0 * record.excess,
                100.0 * record.wrong,
                times.map_or_else(String::new, |times| format!(", {:.1} ± {:.1} ms", times.total, times.spread))
            );
            if !self.shared && main_techniques().iter().any(|(known, _)| known == name) {
                results.masks.insert((format!("{}/{}", self.scene, self.case), how.size, name), shot.mask);
            }
            results.records.push(record);
        }
        Ok(())
    }

    /// Draws all of them: in turns, so that other work on the machine meets all alike, or once where no time is asked.
    fn shoot(&mut self, all: &[Named], how: How) -> Result<Vec<(Shot, Option<Times>)>, String> {
        let drawn: Vec<&dyn ShadowTechnique> = all.iter().map(|(_, remix)| remix as &dyn ShadowTechnique).collect();
        if how.turns == 0 {
            let shots = drawn.iter().map(|technique| Ok((self.studio.shoot(*technique, how.size, 1)?, None)));
            return shots.collect::<Result<_, RunError>>().map_err(|error| error.to_string());
        }
        let timed = self.studio.shoot_in_turns(&drawn, how.size, how.turns).into_iter();
        let taken = timed.map(|timed| {
            let timed = timed.map_err(|error| error.to_string())?;
            let times = Times::of(&timed);
            Ok((timed.shot, Some(times)))
        });
        taken.collect()
    }

    /// What a picture is worth.
    fn record(&self, name: &'static str, shot: &Shot, times: Option<Times>, how: How) -> Result<Record, String> {
        let scores = shot.scores(&self.truth).map_err(|error| error.to_string())?;
        let artefacts = how.closely.then(|| {
            let footprints = Measured::new(&self.visible, &shot.frame, &self.setting, &self.truth.valid);
            let Light::Directional { travel } = self.setting.light else { return Artefacts::default() };
            Artefacts::of(&shot.mask, &self.truth, travel, footprints.perspective)
        });
        Ok(Record {
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
            edge_px: scores.edge_center_px,
            leak: scores.leak_interior,
            acne: scores.false_interior,
            times,
            bytes: shot.bytes,
            artefacts,
        })
    }
}
