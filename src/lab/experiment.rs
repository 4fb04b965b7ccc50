//! One technique, one setting, one map size: drawn on either backend, timed, and compared with the truth.

mod turns;

use std::collections::HashMap;
use std::fmt;
use std::time::Instant;

use super::cpu;
use super::gpu::{Gpu, GpuScene, Race, RenderOptions, Renderer};
use super::metrics::{MaskError, Scores, mask_from_bytes};
use super::report::Row;
use super::statistics::quantile;
use super::subject::{Knowledge, Setting, Subject};
use super::truth::Truth;
use crate::encoding::stage::{Encoding, Prefilter, Radius};
use crate::error::FitError;
use crate::fit::share::Share;
use crate::fit::snap::Stabilise;
use crate::frame::{Pcf, Select, ShadowFrame, WgslKey};
use crate::gpu::{ShadowMaps, ShadowMapsDescriptor};
use crate::remix::Remix;
use crate::scene::MapBudget;
use crate::split::{Scheme, Split};
use crate::technique::{FitInput, ShadowTechnique};
use crate::warp::Warp;

use turns::Fitted;
pub use turns::Timed;

/// Which renderer is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BackendChoice {
    /// The GPU, or the software renderer where there is none.
    #[default]
    Auto,
    /// The GPU, or an error.
    Gpu,
    /// The software renderer.
    Cpu,
}

/// A renderer.
#[derive(Debug)]
pub enum Backend {
    /// Any wgpu adapter, with the pipelines of each shader key that was used.
    Gpu(Box<Gpu>, HashMap<WgslKey, Renderer>),
    /// The software renderer.
    Cpu,
}

/// A run that gave no picture, in one line.
#[derive(Clone, Debug, PartialEq)]
pub enum RunError {
    /// The technique refused its input.
    Fit(FitError),
    /// The renderer failed.
    Render(String),
    /// The picture does not fit the truth.
    Mask(MaskError),
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fit(error) => write!(f, "{error}"),
            Self::Render(error) => write!(f, "{error}"),
            Self::Mask(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for RunError {}

impl Backend {
    /// Opens a renderer; with `Auto`, also says why the GPU is not used if it is not.
    ///
    /// # Errors
    /// One line, when a GPU was asked for and there is none.
    pub fn open(choice: BackendChoice) -> Result<(Self, Option<String>), String> {
        if choice == BackendChoice::Cpu {
            return Ok((Self::Cpu, None));
        }
        match Gpu::new() {
            Ok(gpu) => Ok((Self::Gpu(Box::new(gpu), HashMap::new()), None)),
            Err(error) if choice == BackendChoice::Auto => Ok((Self::Cpu, Some(error.to_string()))),
            Err(error) => Err(error.to_string()),
        }
    }

    /// `gpu` or `cpu`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Gpu(..) => "gpu",
            Self::Cpu => "cpu",
        }
    }

    /// A remix in the formats that the renderer has ([`supported`](crate::gpu::supported)); the software renderer has
    /// all.
    #[must_use]
    pub fn adapted(&self, remix: &Remix) -> Remix {
        let features = match self {
            Self::Gpu(gpu, _) => gpu.device().features(),
            Self::Cpu => wgpu::Features::all(),
        };
        match remix.encoding {
            Encoding::Moments(prefilter) => {
                let moments = crate::gpu::supported(prefilter.moments, features);
                Remix { encoding: Encoding::Moments(Prefilter { moments, ..prefilter }), ..*remix }
            }
            _ => *remix,
        }
    }

    /// Name of the adapter, or of the software renderer.
    #[must_use]
    pub fn adapter(&self) -> String {
        match self {
            Self::Gpu(gpu, _) => gpu.adapter().to_owned(),
            Self::Cpu => format!("software renderer, {} threads", rayon::current_num_threads()),
        }
    }
}

/// A subject in a setting, ready to be drawn again and again.
#[derive(Debug)]
pub struct Studio<'a> {
    backend: &'a mut Backend,
    subject: &'a Subject,
    setting: Setting,
    scene: Prepared,
    seen: Vec<glam::DVec3>,
    /// Layers of every budget; as many as a technique has maps where none are named.
    layers: Option<u32>,
}

/// The scene as the backend wants it.
#[derive(Debug)]
enum Prepared {
    Gpu(GpuScene),
    Cpu(cpu::Visible),
}

/// A picture of the visibility of the light, and what it took.
#[derive(Clone, Debug)]
pub struct Shot {
    /// 255 lit, 0 in shadow, sky 255; row 0 on top.
    pub mask: Vec<u8>,
    /// What was fitted.
    pub frame: ShadowFrame,
    /// Median time of a fit, nanoseconds.
    pub fit_ns: f64,
    /// Drawing the maps, milliseconds.
    pub casters_ms: f64,
    /// Filtering them, milliseconds.
    pub filter_ms: f64,
    /// Looking every visible point up, milliseconds.
    pub receivers_ms: f64,
    /// Memory of the maps, bytes.
    pub bytes: u64,
}

/// Fits that are timed together: one takes about as long as reading the clock forty times.
const FIT_BATCH: u32 = 16;

/// Batches of which the median is reported.
const FIT_BATCHES: usize = 31;

/// Bytes of a texel of a depth map.
const DEPTH_BYTES: u64 = 4;

impl<'a> Studio<'a> {
    /// Uploads the scene (GPU) or draws what the camera sees (CPU).
    ///
    /// # Errors
    /// The device cannot hold the scene.
    pub fn new(backend: &'a mut Backend, subject: &'a Subject, setting: Setting) -> Result<Self, RunError> {
        let scene = match backend {
            Backend::Gpu(gpu, _) => Prepared::Gpu(
                GpuScene::upload(gpu, &subject.model, setting.origin)
                    .map_err(|error| RunError::Render(error.to_string()))?,
            ),
            Backend::Cpu => Prepared::Cpu(cpu::Visible::draw(&subject.model, &setting.camera, setting.origin)),
        };
        let seen = setting.visible_points(subject);
        Ok(Self { backend, subject, setting, scene, seen, layers: None })
    }

    /// The same, in which techniques are told more or less of what is seen than by default.
    #[must_use]
    pub fn knowing(mut self, knowledge: Knowledge) -> Self {
        match knowledge {
            Knowledge::Bounds => self.seen.clear(),
            Knowledge::Points => {}
            Knowledge::Depths => self.setting.visible = self.setting.visible_range(self.subject),
        }
        self
    }

    /// The same, in which budgets have this many layers, however many maps a technique has.
    #[must_use]
    pub fn with_layers(self, layers: u32) -> Self {
        Self { layers: Some(layers), ..self }
    }

    /// Fits a technique, draws it, and times every step; `repetitions` of each pass, medians.
    ///
    /// # Errors
    /// The technique refused its input, or the renderer failed.
    pub fn shoot(&mut self, technique: &dyn ShadowTechnique, side: u32, repetitions: u32) -> Result<Shot, RunError> {
        let Fitted { frame, fit_ns, maps } = self.fitted(technique, side)?;
        match (&*self.backend, &self.scene) {
            (Backend::Gpu(gpu, renderers), Prepared::Gpu(scene)) => {
                let (Some(renderer), Some(maps)) = (renderers.get(&frame.wgsl), maps) else {
                    return Err(RunError::Render("no maps were made".to_owned()));
                };
                let options = RenderOptions { repetitions };
                let image = renderer
                    .render(gpu, scene, &self.setting.camera, &frame, &maps, &options)
                    .map_err(|error| RunError::Render(error.to_string()))?;
                let times = image.timings;
                let (casters_ms, filter_ms, receivers_ms) = (times.casters_ms, times.filter_ms, times.receivers_ms);
                Ok(Shot { mask: image.mask, frame, fit_ns, casters_ms, filter_ms, receivers_ms, bytes: maps.bytes() })
            }
            (_, Prepared::Cpu(visible)) => {
                let image = cpu::render(self.subject, visible, &frame, &self.setting);
                let bytes = DEPTH_BYTES * texels(&frame);
                let (casters_ms, filter_ms, receivers_ms) = (image.casters_ms, image.filter_ms, image.receivers_ms);
                Ok(Shot { mask: image.mask, frame, fit_ns, casters_ms, filter_ms, receivers_ms, bytes })
            }
            (Backend::Cpu, Prepared::Gpu(_)) => Err(RunError::Render("the scene was prepared for a GPU".to_owned())),
        }
    }
}

impl Studio<'_> {
    /// The library's passes beside passes written by hand, in turns; `None` on the software renderer.
    ///
    /// # Errors
    /// As [`shoot`](Self::shoot).
    pub fn race(
        &mut self,
        technique: &dyn ShadowTechnique,
        side: u32,
        repetitions: u32,
    ) -> Result<Option<Race>, RunError> {
        let input = self.setting.input(self.subject, &self.seen, technique.wgsl_key(), side);
        let map = MapBudget { layers: self.layers.unwrap_or(input.map.layers), ..input.map };
        let input = FitInput { map, ..input };
        let frame = technique.fit(&input).map_err(RunError::Fit)?;
        let (Backend::Gpu(gpu, renderers), Prepared::Gpu(scene)) = (&mut *self.backend, &self.scene) else {
            return Ok(None);
        };
        let failed = |error: &dyn fmt::Display| RunError::Render(error.to_string());
        let renderer = renderers.entry(frame.wgsl).or_insert_with(|| Renderer::new(gpu, frame.wgsl));
        let descriptor = ShadowMapsDescriptor { label: Some("antumbra lab"), key: frame.wgsl, map: input.map };
        let maps = ShadowMaps::new(gpu.device(), &descriptor).map_err(|error| failed(&error))?;
        let race = renderer.race(gpu, scene, &self.setting.camera, &frame, &maps, repetitions);
        race.map(Some).map_err(|error| failed(&error))
    }
}

impl Shot {
    /// Texels of the maps that are drawn: those of views, whatever layers they are in.
    #[must_use]
    pub fn texels(&self) -> u64 {
        texels(&self.frame)
    }

    /// Compares the picture with the truth.
    ///
    /// # Errors
    /// The picture has another size than the truth.
    pub fn scores(&self, truth: &Truth) -> Result<Scores, RunError> {
        Scores::new(&mask_from_bytes(&self.mask), truth).map_err(RunError::Mask)
    }

    /// Writes times, sizes and errors into a row whose names are already there.
    pub fn fill(&self, row: &mut Row, scores: &Scores) {
        row.views = u32::try_from(self.frame.views.len()).unwrap_or(u32::MAX);
        row.texels = self.texels();
        row.bytes = self.bytes;
        row.fit_ns = self.fit_ns;
        row.casters_ms = self.casters_ms;
        row.filter_ms = self.filter_ms;
        row.receivers_ms = self.receivers_ms;
        row.total_ms = self.fit_ns * 1e-6 + self.casters_ms + self.filter_ms + self.receivers_ms;
        row.rmse = scores.rmse;
        row.mae = scores.mae;
        row.floor_mae = scores.floor_mae;
        row.wrong = scores.wrong;
        row.wrong_center = scores.wrong_center;
        row.edge_center_px = scores.edge_center_px.unwrap_or(f64::NAN);
        row.leak_edge = scores.leak_edge;
        row.leak_interior = scores.leak_interior;
        row.false_edge = scores.false_edge;
        row.false_interior = scores.false_interior;
        row.predicted_px = f64::from(self.frame.predicted.max);
        row.left_out = self.frame.left_out.iter().map(ToString::to_string).collect();
    }
}

/// Names of a remix's stages: split, warp, encoding.
#[must_use]
pub fn stage_names(remix: &Remix) -> [String; 3] {
    let encoding = match remix.encoding {
        Encoding::Depth(filter) => format!("depth {}", filter.name()),
        Encoding::Soft { angle } => format!("depth {}, {angle} rad", Pcf::Pcss.name()),
        Encoding::Moments(prefilter) => moments_name(&prefilter),
    };
    let warp = match remix.warp {
        Warp::Uniform => "uniform".to_owned(),
        Warp::Focused => "focused".to_owned(),
        Warp::LeastError => "least error".to_owned(),
        Warp::Trapezoidal { .. } => "trapezoidal".to_owned(),
        Warp::LightSpacePerspective => "light-space perspective".to_owned(),
        Warp::Perspective { .. } => "perspective".to_owned(),
        Warp::Minimax => "minimax".to_owned(),
        Warp::Fixed { strength } => format!("strength {strength}"),
    };
    let snapped = if remix.stabilise == Stabilise::SnapTexels { ", snapped" } else { "" };
    [split_name(remix), format!("{warp}{snapped}"), encoding]
}

/// Name of moments, their format, and the width of their blur in texels or world units.
fn moments_name(prefilter: &Prefilter) -> String {
    let moments = prefilter.moments;
    let blur = match prefilter.radius {
        Radius::Texels(radius) => format!("{} texels", 2.0 * radius),
        Radius::World(radius) => format!("{} wide", 2.0 * radius),
    };
    let mips = if moments.mips { ", mips" } else { "" };
    format!("{} {}, {blur}{mips}", moments.kind().name(), moments.format().name())
}

/// Name of a remix's split.
fn split_name(remix: &Remix) -> String {
    let Split::Depth(splits) = remix.split else { return "one map".to_owned() };
    let scheme = match splits.scheme {
        Scheme::Uniform => "uniform".to_owned(),
        Scheme::Logarithmic => "logarithmic".to_owned(),
        Scheme::Practical { lambda, .. } => format!("practical {lambda}"),
        Scheme::Manual(_) => "manual".to_owned(),
        Scheme::EqualError => "equal error".to_owned(),
    };
    let select = if splits.select == Select::Finest { ", finest" } else { "" };
    let blend = if splits.blend > 0.0 { ", blended" } else { "" };
    let share = match remix.share {
        Share::Equal => "",
        Share::EqualError => ", texels by equal error",
        Share::LeastError => ", texels by least error",
    };
    format!("{} maps, {scheme}{select}{blend}{share}", splits.maps)
}

/// Texels of a frame's views.
fn texels(frame: &ShadowFrame) -> u64 {
    frame.views.iter().map(|view| u64::from(view.viewport.z) * u64::from(view.viewport.w)).sum()
}

/// Median over batches of the mean time of a call, nanoseconds.
fn median_fit_ns(mut fit: impl FnMut() -> bool) -> f64 {
    let batches: Vec<f64> = (0..FIT_BATCHES)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..FIT_BATCH {
                std::hint::black_box(fit());
            }
            start.elapsed().as_secs_f64() * 1e9 / f64::from(FIT_BATCH)
        })
        .collect();
    quantile(&batches, 0.5)
}
