//! The sweep of the "Gz" report: whole-numbered depths, nearest texel, one constant bias, a teapot and two lights.

use antumbra::lab::case::{Case, CaseCamera, CaseLight};
use antumbra::lab::cpu::Visible;
use antumbra::lab::metrics::detachment::{Contact, contacts, detachment};
use antumbra::lab::metrics::{Edges, Scores, mask_from_bytes, near_edges};
use antumbra::lab::raster::{DepthMode, DepthTarget, RasterPass, rasterise, resolve};
use antumbra::lab::scene::SceneModel;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::lab::teapot::teapot;
use antumbra::lab::truth::{Truth, TruthCache};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// Depths of the report's maps run from 0 to this.
pub(crate) const INT_MAX: f64 = 2_147_483_647.0;

/// Side of a map, texels.
pub(crate) const SIDE: u32 = 512;

/// Quads along a side of each of the teapot's patches.
const STEPS: u32 = 16;

/// Biases of the report: from this one on, by factors of √10.
const FIRST: f64 = 0.5;

/// Steps from the first one to 5·10⁵, and beyond, to where shadows vanish.
const STEPS_TO: [i32; 2] = [12, 18];

/// The bias that the report needed for another camera.
pub(crate) const SECOND_CAMERA: f64 = 8e5;

/// The bias that the report settled on.
pub(crate) const REPORT: f64 = 5e5;

/// Pixels on each side of a pixel that the low-pass filter averages: 5 × 5. One stripe of acne and more; wider ones
/// reach across edges.
const BOX: usize = 2;

/// A perspective "camera" at a light, as the report has it. Its place and opening are ours: the report has neither.
#[derive(Clone, Copy, Debug)]
struct Light {
    name: &'static str,
    position: DVec3,
    target: DVec3,
}

/// From the left and from behind, so that both throw the teapot's shadow to where the camera sees its beginning.
const LIGHTS: [Light; 2] = [
    Light { name: "light 1", position: DVec3::new(-8.0, 8.0, -1.0), target: DVec3::new(0.0, 0.5, 0.0) },
    Light { name: "light 2", position: DVec3::new(4.0, 7.0, -9.0), target: DVec3::new(0.0, 0.5, 0.0) },
];

/// Tangent of half the opening of a light's view: it holds the table.
const TANGENT: f64 = 0.65;

/// Distance of the image plane, where depth is 0, from a light: what the Gz projection has, 1/tangent.
const NEAR: f64 = 1.0 / TANGENT;

/// One bias under one light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Units of depth, of [`INT_MAX`].
    pub(crate) bias: f64,
    /// Shares of the valid pixels.
    pub(crate) acne: f64,
    pub(crate) leak: f64,
    /// Mean width of the lit strips, pixels.
    pub(crate) detached_px: f64,
    /// Share of the contacts that are detached.
    pub(crate) detached: f64,
}

/// How far interpolated light-space depths are from projected ones, at most, of [`INT_MAX`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Interpolated {
    pub(crate) homogeneous: f64,
    pub(crate) divided: f64,
}

/// What was found under one light.
#[derive(Clone, Debug)]
pub(crate) struct Swept {
    pub(crate) name: &'static str,
    pub(crate) contacts: usize,
    pub(crate) valid: usize,
    pub(crate) steps: Vec<Step>,
    /// Mean light where all of it arrives, away from edges, 0 to 1: without a bias, the same after a low-pass filter over
    /// the picture, and with the report's bias.
    pub(crate) light: [f64; 3],
    pub(crate) interpolated: Interpolated,
}

/// Sweeps both lights.
pub(crate) fn sweep() -> Result<Vec<Swept>, String> {
    let subject = Subject::new(teapot(STEPS));
    LIGHTS.iter().map(|light| light.sweep(&subject)).collect()
}

/// The report's steps, in order.
fn biases() -> Vec<f64> {
    let mut biases: Vec<f64> = (0..=STEPS_TO[1]).map(|step| FIRST * 10_f64.powf(0.5 * f64::from(step))).collect();
    biases.push(SECOND_CAMERA);
    biases.sort_by(f64::total_cmp);
    biases
}

/// A camera that sees the whole table.
fn case(light: &Light) -> Case {
    Case {
        name: light.name.to_owned(),
        scene: "teapot".to_owned(),
        camera: CaseCamera {
            eye: DVec3::new(4.5, 4.6, 7.5),
            target: DVec3::new(0.4, 1.0, 0.0),
            up: DVec3::Y,
            fov_y_deg: 45.0,
            near: 0.1,
            far: 100.0,
        },
        light: CaseLight::Point { position: light.position, range: 100.0 },
        viewport: [640, 480],
        shadow_distance: 100.0,
        folder: std::path::PathBuf::new(),
    }
}

impl Light {
    /// Clip space of its map: depth 1 − near/D at a distance D along its axis, as Gz's projection has it.
    fn clip_from_world(&self) -> DMat4 {
        let forward = (self.target - self.position).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(self.position) * scale);
        let depth = row(forward, 1.0);
        let rows = [row(right, NEAR), row(right.cross(forward), NEAR), depth - DVec4::new(0.0, 0.0, 0.0, NEAR), depth];
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    fn sweep(&self, subject: &Subject) -> Result<Swept, String> {
        let case = case(self);
        let (truth, _) = TruthCache::default().get(&case, &subject.model, &|| {});
        let setting = Setting::of(&case);
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        let clip = self.clip_from_world();
        let margins = margins(&subject.model, &visible, &setting, &clip);
        let found = contacts(&case, &truth);
        let mut swept = Swept {
            name: self.name,
            contacts: found.len(),
            valid: truth.valid_count(),
            steps: Vec::new(),
            light: [0.0; 3],
            interpolated: interpolated(&subject.model, &visible, &setting, &clip),
        };
        let threshold = |bias: f64| -> Vec<u8> {
            let lit = |margin: &Option<i64>| margin.is_none_or(|margin| margin as f64 <= bias);
            margins.iter().map(|margin| if lit(margin) { u8::MAX } else { 0 }).collect()
        };
        for bias in biases() {
            let mask = threshold(bias);
            swept.steps.push(Step::of(bias, &mask, &truth, &found)?);
            crate::save(&format!("teapot {} {bias:.0}", self.name), &mask, &truth)?;
        }
        let bare = mask_from_bytes(&threshold(0.0));
        let filtered = low_passed(&bare, truth.width as usize);
        swept.light = [bare, filtered, mask_from_bytes(&threshold(REPORT))].map(|mask| mean_light(&mask, &truth));
        Ok(swept)
    }
}

impl Step {
    fn of(bias: f64, mask: &[u8], truth: &Truth, found: &[Contact]) -> Result<Self, String> {
        let mask = mask_from_bytes(mask);
        let scores = Scores::new(&mask, truth).map_err(|error| error.to_string())?;
        let strips = detachment(&mask, truth, found).map_err(|error| error.to_string())?;
        let (acne, leak) = (scores.false_interior, scores.leak_interior);
        println!("{bias:e}: acne {acne}, leak {leak}, {strips:?}");
        Ok(Self { bias, acne, leak, detached_px: strips.mean_px, detached: strips.share })
    }
}

/// The mean of a box around every pixel.
fn low_passed(mask: &[f32], width: usize) -> Vec<f32> {
    let height = mask.len() / width;
    let around = |at: usize, count: usize| at.saturating_sub(BOX)..(at + BOX + 1).min(count);
    let mean = |pixel: usize| {
        let (columns, rows) = (around(pixel % width, width), around(pixel / width, height));
        let count = (columns.len() * rows.len()) as f32;
        rows.flat_map(|row| columns.clone().map(move |column| mask[row * width + column])).sum::<f32>() / count
    };
    (0..mask.len()).map(mean).collect()
}

/// Mean light where the truth is lit, away from edges.
fn mean_light(mask: &[f32], truth: &Truth) -> f64 {
    let near = near_edges(truth, Edges::Area);
    let lit = (0..mask.len()).filter(|at| truth.valid[*at] && truth.centre[*at] == 1.0 && !near[*at]);
    let (sum, count) = lit.fold((0.0, 0.0), |(sum, count), at| (sum + f64::from(mask[at]), count + 1.0));
    sum / f64::max(count, 1.0)
}

/// By how much each pixel is deeper than what its nearest texel holds; `None` where no texel answers.
fn margins(model: &SceneModel, visible: &Visible, setting: &Setting, clip: &DMat4) -> Vec<Option<i64>> {
    // Depths at texel centres, in f64, rounded down to whole numbers.
    let mut target = DepthTarget::new(SIDE, SIDE, DepthMode::LessEqual);
    let pass = RasterPass { clip_from_render: clip.as_mat4(), depth_from_render: None, origin: DVec3::ZERO };
    rasterise(&mut target, model, &model.objects, &pass);
    let whole = |at: DVec4| (INT_MAX * at.z / at.w).floor() as i64;
    let hits = resolve(&target, model, &clip.inverse(), DVec3::ZERO);
    let stored: Vec<Option<i64>> =
        hits.iter().map(|hit| hit.map(|hit| whole(*clip * hit.position.extend(1.0)))).collect();
    // What every pixel has in the texel that it falls into.
    let margin = |pixel: usize| {
        let at = *clip * (visible.pixel(pixel)?.position + setting.origin).extend(1.0);
        let unit = DVec2::new(at.x, -at.y) / at.w * 0.5 + 0.5;
        let texel = (unit * f64::from(SIDE)).floor();
        if texel.min_element() < 0.0 || texel.max_element() >= f64::from(SIDE) {
            return None;
        }
        Some(whole(at) - stored[texel.y as usize * SIDE as usize + texel.x as usize]?)
    };
    let [width, height] = setting.camera.viewport.to_array();
    (0..(width * height) as usize).map(margin).collect()
}

/// Light-space depths interpolated over the triangles that are seen, before and after the division.
fn interpolated(model: &SceneModel, visible: &Visible, setting: &Setting, clip: &DMat4) -> Interpolated {
    let picture = antumbra::lab::projection::clip_from_render(&setting.camera, setting.origin);
    let mut most = Interpolated::default();
    for hit in visible.iter() {
        // As the rasteriser has them.
        let corners = model.corners(hit.triangle as usize).map(|corner| (corner - setting.origin).as_vec3().as_dvec3());
        let seen = corners.map(|corner| picture * corner.extend(1.0));
        let here = picture * hit.position.extend(1.0);
        let [a, b, c] = seen.map(|corner| corner.truncate().truncate() / corner.w);
        let at = here.truncate().truncate() / here.w;
        let area = (b - a).perp_dot(c - a);
        let linear = [(b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)];
        // Slivers have no weights to speak of.
        if area.abs() < 1e-7 || seen.iter().any(|corner| corner.w <= 0.0) {
            continue;
        }
        let light = corners.map(|corner| *clip * (corner + setting.origin).extend(1.0));
        let over_w: DVec4 = (0..3).map(|i| light[i] * (linear[i] / area / seen[i].w)).sum();
        let divided: f64 = (0..3).map(|i| light[i].z / light[i].w * linear[i] / area).sum();
        let exact = *clip * (hit.position + setting.origin).extend(1.0);
        let exact = exact.z / exact.w;
        most.homogeneous = most.homogeneous.max(INT_MAX * (over_w.z / over_w.w - exact).abs());
        most.divided = most.divided.max(INT_MAX * (divided - exact).abs());
    }
    most
}
