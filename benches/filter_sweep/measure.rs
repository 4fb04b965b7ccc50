//! Photographs and times.

use std::collections::HashMap;
use std::path::Path;

use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::case::Case;
use antumbra::lab::cli::encode_png;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::files::write_whole;
use antumbra::lab::gpu::{Entrant, Gpu, GpuScene, PassTimes, Renderer, Turns, draw_in_turns};
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::lab::statistics::quantile;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{ShadowFrame, ShadowTechnique, WgslKey};
use image::ExtendedColorType;

use crate::SIDE;
use crate::contenders::{Contender, of_width};

/// A time over turns, milliseconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Time {
    /// Median.
    pub(crate) ms: f64,
    /// Half the distance between the quartiles.
    pub(crate) spread: f64,
}

impl Time {
    fn of(times: &[PassTimes], figure: fn(&PassTimes) -> f64) -> Self {
        let times: Vec<f64> = times.iter().map(figure).collect();
        let [low, ms, high] = [0.25, 0.5, 0.75].map(|share| quantile(&times, share));
        Self { ms, spread: 0.5 * (high - low) }
    }
}

/// One picture.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) case: String,
    pub(crate) width: u32,
    pub(crate) name: String,
    pub(crate) filter: Time,
    pub(crate) receivers: Time,
    /// Filter and receivers of a turn, together.
    pub(crate) total: Time,
    pub(crate) mae: f64,
    pub(crate) excess: f64,
    /// Root mean square distance from the yardstick's picture.
    pub(crate) distance: f64,
    pub(crate) leak: f64,
    pub(crate) acne: f64,
}

/// The adapter, what was compiled for it, and what was found.
pub(crate) struct Bench<'a> {
    gpu: &'a Gpu,
    turns: u32,
    renderers: HashMap<(WgslKey, Option<u32>), Renderer>,
    pub(crate) records: Vec<Record>,
}

/// A contender, ready to be drawn.
struct Entry {
    contender: Contender,
    frame: ShadowFrame,
    maps: ShadowMaps,
}

impl<'a> Bench<'a> {
    pub(crate) fn new(gpu: &'a Gpu, turns: u32) -> Self {
        Self { gpu, turns, renderers: HashMap::new(), records: Vec::new() }
    }

    /// Photographs a case at every width.
    pub(crate) fn run(&mut self, assignment: &Assignment, case: &Case, widths: &[u32]) -> Result<(), String> {
        let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
        let setting = Setting::of(case);
        let scene =
            GpuScene::upload(self.gpu, &assignment.subject.model, setting.origin).map_err(|error| error.to_string())?;
        for width in widths {
            let mut entries = Vec::new();
            for contender in of_width(self.gpu, *width) {
                let input = setting.input(&assignment.subject, &[], contender.remix.wgsl_key(), SIDE);
                let frame = contender.remix.fit(&input).map_err(|error| error.to_string())?;
                entries.push(self.entry(contender, frame, &input.map)?);
            }
            let drawn = self.draw(&scene, &setting, &entries)?;
            self.note(&case.name, *width, &entries, &drawn, &truth)?;
        }
        Ok(())
    }

    /// Turn by turn, in alternating order.
    fn draw(&self, scene: &GpuScene, setting: &Setting, entries: &[Entry]) -> Result<Vec<Turns>, String> {
        let renderer = |entry: &Entry| &self.renderers[&(entry.frame.wgsl, entry.contender.taps)];
        let entrants = entries.iter();
        let entrants: Vec<Entrant> = entrants
            .map(|entry| Entrant { renderer: renderer(entry), frame: &entry.frame, maps: &entry.maps })
            .collect();
        let drawn = draw_in_turns(self.gpu, scene, &setting.camera, &entrants, self.turns);
        drawn.into_iter().map(|turns| turns.map_err(|error| error.to_string())).collect()
    }

    fn entry(&mut self, contender: Contender, frame: ShadowFrame, map: &antumbra::MapBudget) -> Result<Entry, String> {
        let (key, gpu) = (frame.wgsl, self.gpu);
        let descriptor = ShadowMapsDescriptor { label: Some("filter sweep"), key, map: *map };
        let maps = ShadowMaps::new(gpu.device(), &descriptor).map_err(|error| error.to_string())?;
        self.renderers.entry((key, contender.taps)).or_insert_with(|| match contender.taps {
            Some(taps) => Renderer::with_box(gpu, key, taps),
            None => Renderer::new(gpu, key),
        });
        Ok(Entry { contender, frame, maps })
    }

    fn note(
        &mut self,
        case: &str,
        width: u32,
        entries: &[Entry],
        drawn: &[Turns],
        truth: &Truth,
    ) -> Result<(), String> {
        let yardstick = mask_from_bytes(&drawn[0].image.mask);
        for (entry, Turns { image, times }) in entries.iter().zip(drawn) {
            let mask = mask_from_bytes(&image.mask);
            save(case, width, &entry.contender.name, &image.mask, truth)?;
            let scores = Scores::new(&mask, truth).map_err(|error| error.to_string())?;
            let squares =
                (0..mask.len()).filter(|at| truth.valid[*at]).map(|at| f64::from(mask[at] - yardstick[at]).powi(2));
            let record = Record {
                case: case.to_owned(),
                width,
                name: entry.contender.name.clone(),
                filter: Time::of(times, |times| times.filter_ms),
                receivers: Time::of(times, |times| times.receivers_ms),
                total: Time::of(times, |times| times.filter_ms + times.receivers_ms),
                mae: scores.mae,
                excess: scores.excess,
                distance: (squares.sum::<f64>() / truth.valid_count() as f64).sqrt(),
                leak: scores.leak_interior,
                acne: scores.false_interior,
            };
            println!(
                "{case} {width} {}: filter {:.1}, receivers {:.1} ms, excess {:.2} %, {:.3} from PCF",
                record.name,
                record.filter.ms,
                record.receivers.ms,
                100.0 * record.excess,
                record.distance
            );
            self.records.push(record);
        }
        Ok(())
    }
}

/// Keeps a picture, to be looked at.
fn save(case: &str, width: u32, contender: &str, mask: &[u8], truth: &Truth) -> Result<(), String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/filter_sweep");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let png = encode_png(mask, truth.width, truth.height, ExtendedColorType::L8)?;
    let name = format!("{case} {width} {contender}.png").replace(['/', ' ', ','], "-");
    write_whole(&folder.join(name), &png)
}
