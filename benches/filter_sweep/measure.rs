//! Photographs and times.

use std::collections::HashMap;
use std::path::Path;

use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::case::Case;
use antumbra::lab::cli::encode_png;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::files::write_whole;
use antumbra::lab::gpu::{Gpu, GpuScene, PassTimes, RenderOptions, Renderer};
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::lab::statistics::quantile;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{ShadowFrame, ShadowTechnique, WgslKey};
use image::ExtendedColorType;

use crate::SIDE;
use crate::contenders::{Contender, of_width};

/// One picture.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) case: String,
    pub(crate) width: u32,
    pub(crate) name: String,
    pub(crate) filter_ms: f64,
    pub(crate) receivers_ms: f64,
    pub(crate) mae: f64,
    pub(crate) excess: f64,
    /// Root mean square distance from the yardstick's picture.
    pub(crate) distance: f64,
    pub(crate) leak: f64,
    pub(crate) acne: f64,
}

impl Record {
    pub(crate) fn total_ms(&self) -> f64 {
        self.filter_ms + self.receivers_ms
    }
}

/// The adapter, what was compiled for it, and what was found.
pub(crate) struct Bench<'a> {
    gpu: &'a Gpu,
    turns: usize,
    renderers: HashMap<(WgslKey, Option<u32>), Renderer>,
    pub(crate) records: Vec<Record>,
}

/// A contender, ready to be drawn.
struct Entry {
    contender: Contender,
    frame: ShadowFrame,
    maps: ShadowMaps,
    times: Vec<PassTimes>,
    mask: Vec<u8>,
}

impl<'a> Bench<'a> {
    pub(crate) fn new(gpu: &'a Gpu, turns: usize) -> Self {
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
            // Turn by turn, so that other work on the machine meets all of them.
            for _ in 0..self.turns {
                for entry in &mut entries {
                    let renderer = &self.renderers[&(entry.frame.wgsl, entry.contender.taps)];
                    let options = RenderOptions { repetitions: 1 };
                    let image = renderer
                        .render(self.gpu, &scene, &setting.camera, &entry.frame, &entry.maps, &options)
                        .map_err(|error| error.to_string())?;
                    entry.times.push(image.timings);
                    entry.mask = image.mask;
                }
            }
            self.note(&case.name, *width, &entries, &truth)?;
        }
        Ok(())
    }

    fn entry(&mut self, contender: Contender, frame: ShadowFrame, map: &antumbra::MapBudget) -> Result<Entry, String> {
        let (key, gpu) = (frame.wgsl, self.gpu);
        let descriptor = ShadowMapsDescriptor { label: Some("filter sweep"), key, map: *map };
        let maps = ShadowMaps::new(gpu.device(), &descriptor).map_err(|error| error.to_string())?;
        self.renderers.entry((key, contender.taps)).or_insert_with(|| match contender.taps {
            Some(taps) => Renderer::with_box(gpu, key, taps),
            None => Renderer::new(gpu, key),
        });
        Ok(Entry { contender, frame, maps, times: Vec::new(), mask: Vec::new() })
    }

    fn note(&mut self, case: &str, width: u32, entries: &[Entry], truth: &Truth) -> Result<(), String> {
        let yardstick = mask_from_bytes(&entries[0].mask);
        for entry in entries {
            let mask = mask_from_bytes(&entry.mask);
            save(case, width, entry, truth)?;
            let scores = Scores::new(&mask, truth).map_err(|error| error.to_string())?;
            let squares =
                (0..mask.len()).filter(|at| truth.valid[*at]).map(|at| f64::from(mask[at] - yardstick[at]).powi(2));
            let median =
                |figure: fn(&PassTimes) -> f64| quantile(&entry.times.iter().map(figure).collect::<Vec<_>>(), 0.5);
            let record = Record {
                case: case.to_owned(),
                width,
                name: entry.contender.name.clone(),
                filter_ms: median(|times| times.filter_ms),
                receivers_ms: median(|times| times.receivers_ms),
                mae: scores.mae,
                excess: scores.excess,
                distance: (squares.sum::<f64>() / truth.valid_count() as f64).sqrt(),
                leak: scores.leak_interior,
                acne: scores.false_interior,
            };
            println!(
                "{case} {width} {}: filter {:.1}, receivers {:.1} ms, excess {:.2} %, {:.3} from PCF",
                record.name,
                record.filter_ms,
                record.receivers_ms,
                100.0 * record.excess,
                record.distance
            );
            self.records.push(record);
        }
        Ok(())
    }
}

/// Keeps a picture, to be looked at.
fn save(case: &str, width: u32, entry: &Entry, truth: &Truth) -> Result<(), String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/filter_sweep");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let png = encode_png(&entry.mask, truth.width, truth.height, ExtendedColorType::L8)?;
    let name = format!("{case} {width} {}.png", entry.contender.name).replace(['/', ' ', ','], "-");
    write_whole(&folder.join(name), &png)
}
