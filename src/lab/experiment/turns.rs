//! Several techniques at one map size, drawn turn by turn.

use std::collections::HashMap;

use super::{Backend, Prepared, RunError, Shot, Studio, median_fit_ns};
use crate::frame::{ShadowFrame, WgslKey};
use crate::gpu::{ShadowMaps, ShadowMapsDescriptor};
use crate::lab::gpu::{Entrant, PassTimes, Renderer, Turns, draw_in_turns};
use crate::lab::statistics::quantile;
use crate::scene::MapBudget;
use crate::technique::{FitInput, ShadowTechnique};

/// A picture, and what every turn of it took.
#[derive(Clone, Debug)]
pub struct Timed {
    /// The picture, with medians over the turns.
    pub shot: Shot,
    /// Each turn's casters, filter and receivers, milliseconds.
    pub passes: Vec<[f64; 3]>,
}

/// A technique that was fitted, with its maps where there is a device for them.
pub(super) struct Fitted {
    pub(super) frame: ShadowFrame,
    pub(super) fit_ns: f64,
    pub(super) maps: Option<ShadowMaps>,
}

impl Fitted {
    fn entrant<'a>(&'a self, renderers: &'a HashMap<WgslKey, Renderer>) -> Option<Entrant<'a>> {
        let Self { frame, maps, .. } = self;
        Some(Entrant { renderer: renderers.get(&frame.wgsl)?, frame, maps: maps.as_ref()? })
    }
}

impl Studio<'_> {
    /// Fits techniques, and draws all of them turn by turn, `turns` times (at least once), each into maps of its own:
    /// times of one turn are neighbours. One that fails leaves the others alone.
    #[must_use]
    pub fn shoot_in_turns(
        &mut self,
        techniques: &[&dyn ShadowTechnique],
        side: u32,
        turns: u32,
    ) -> Vec<Result<Timed, RunError>> {
        // Fit all, and compile what is missing.
        let fitted: Vec<Result<Fitted, RunError>> =
            techniques.iter().map(|technique| self.fitted(*technique, side)).collect();
        let (Backend::Gpu(gpu, renderers), Prepared::Gpu(scene)) = (&*self.backend, &self.scene) else {
            return techniques.iter().map(|technique| self.repeated(*technique, side, turns)).collect();
        };
        // Draw those that could be fitted.
        let entrants: Vec<Entrant> = fitted.iter().flatten().filter_map(|fitted| fitted.entrant(renderers)).collect();
        let mut drawn = draw_in_turns(gpu, scene, &self.setting.camera, &entrants, turns).into_iter();
        let timed = |fitted: Result<Fitted, RunError>| {
            let drawn = fitted.map(|fitted| (fitted, drawn.next()))?;
            let (Fitted { frame, fit_ns, maps: Some(maps) }, Some(turns)) = drawn else {
                return Err(RunError::Render("no maps were made".to_owned()));
            };
            let turns = turns.map_err(|error| RunError::Render(error.to_string()))?;
            Ok(of_gpu(turns, frame, fit_ns, maps.bytes()))
        };
        fitted.into_iter().map(timed).collect()
    }

    /// Fits, and on a GPU makes maps and what pipelines are missing.
    pub(super) fn fitted(&mut self, technique: &dyn ShadowTechnique, side: u32) -> Result<Fitted, RunError> {
        let input = self.setting.input(self.subject, &self.seen, technique.wgsl_key(), side);
        let map = MapBudget { layers: self.layers.unwrap_or(input.map.layers), ..input.map };
        let input = FitInput { map, ..input };
        let frame = technique.fit(&input).map_err(RunError::Fit)?;
        let fit_ns = median_fit_ns(|| technique.fit(&input).is_ok());
        let Backend::Gpu(gpu, renderers) = &mut *self.backend else {
            return Ok(Fitted { frame, fit_ns, maps: None });
        };
        renderers.entry(frame.wgsl).or_insert_with(|| Renderer::new(gpu, frame.wgsl));
        let descriptor = ShadowMapsDescriptor { label: Some("antumbra lab"), key: frame.wgsl, map };
        let maps = ShadowMaps::new(gpu.device(), &descriptor).map_err(|error| RunError::Render(error.to_string()))?;
        Ok(Fitted { frame, fit_ns, maps: Some(maps) })
    }

    /// The software renderer has no passes to interleave.
    fn repeated(&mut self, technique: &dyn ShadowTechnique, side: u32, turns: u32) -> Result<Timed, RunError> {
        let mut passes = Vec::new();
        let mut shot = self.shoot(technique, side, 1)?;
        for _ in 0..turns.max(1) {
            shot = self.shoot(technique, side, 1)?;
            passes.push([shot.casters_ms, shot.filter_ms, shot.receivers_ms]);
        }
        let median = |pass: usize| quantile(&passes.iter().map(|turn| turn[pass]).collect::<Vec<_>>(), 0.5);
        let shot = Shot { casters_ms: median(0), filter_ms: median(1), receivers_ms: median(2), ..shot };
        Ok(Timed { shot, passes })
    }
}

fn of_gpu(turns: Turns, frame: ShadowFrame, fit_ns: f64, bytes: u64) -> Timed {
    let PassTimes { casters_ms, filter_ms, receivers_ms, .. } = turns.image.timings;
    let passes = turns.times.iter().map(|times| [times.casters_ms, times.filter_ms, times.receivers_ms]).collect();
    let mask = turns.image.mask;
    Timed { shot: Shot { mask, frame, fit_ns, casters_ms, filter_ms, receivers_ms, bytes }, passes }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::comparison::Assignment;
    use crate::lab::experiment::BackendChoice;
    use crate::lab::subject::Setting;
    use crate::{Bias, Remix, techniques};

    #[test]
    fn turns_draw_what_single_shots_draw() {
        let mut assignment = Assignment::of_scene("sparse-city").unwrap();
        let case = assignment.cases.first_mut().unwrap();
        case.viewport = [80, 60];
        let broken = Remix {
            bias: Bias::Manual { depth_world: f32::NAN, slope_texels: 0.0, normal_texels: 0.0 },
            ..techniques::fsm()
        };
        let all = [techniques::fsm(), broken, techniques::cascades(), techniques::vsm()];
        for choice in [BackendChoice::Cpu, BackendChoice::Auto] {
            let (mut backend, _) = Backend::open(choice).unwrap();
            let all = all.map(|remix| backend.adapted(&remix));
            let mut studio = Studio::new(&mut backend, &assignment.subject, Setting::of(&assignment.cases[0])).unwrap();
            let timed = studio.shoot_in_turns(&all.each_ref().map(|remix| remix as &dyn ShadowTechnique), 128, 3);
            assert_eq!(timed.len(), all.len());
            for (index, (timed, remix)) in timed.iter().zip(&all).enumerate() {
                let (Ok(timed), 0 | 2 | 3) = (timed, index) else {
                    // The one that is refused stays in its place, with its error.
                    assert!(index == 1 && matches!(timed, Err(RunError::Fit(_))), "{index}: {timed:?}");
                    continue;
                };
                let alone = studio.shoot(remix, 128, 1).unwrap();
                assert_eq!((&timed.shot.mask, &timed.shot.frame), (&alone.mask, &alone.frame), "{index}");
                assert_eq!((timed.passes.len(), timed.shot.bytes), (3, alone.bytes));
                assert!(timed.passes.iter().all(|[casters, _, receivers]| *casters > 0.0 && *receivers > 0.0));
            }
        }
    }
}
