//! Shader functions against their Rust twins, on an adapter.
//!
//! Both sides round every operation, in an order that compilers may change, so two bounds hold:
//! - a lookup differs by the rounding of its own formula, propagated to first order ([`LookupBound`]; for warped maps, operation
//!   by operation: [`Rounded`]);
//! - a comparison can tip over where depths are that close, and a texel change where coordinates are; the result then
//!   lies between the twin's values on both sides of the doubt. Samplers may keep 8 bits of the place between texels,
//!   rounded (as the twin does) or cut, or all of them: that changes a weight by at most 1/256 along each axis, and so
//!   any mean of taps by at most 2/256. (llvmpipe keeps all bits, half a step from the twin: it stays below 1/256.)

mod rounded;
mod support;

use antumbra::encoding::depth::{
    CompareMap, DepthMap, Lookup, antumbra_box_row, antumbra_caster, antumbra_caster_depth, antumbra_filter,
    antumbra_lookup, antumbra_lookup_projective, antumbra_tap, antumbra_visible,
};
use antumbra::gpu::{self, ShadowMaps, ShadowMapsDescriptor, wgpu};
use antumbra::lab::gpu::{Gpu, read_depth};
use antumbra::warp::{Focus, Warp};
use antumbra::wgsl::{self, Bindings};
use antumbra::{
    Aabb, Bias, DepthLaw, Encoding, FitInput, Light, MapBudget, MapShape, Pcf, Remix, Scene, ShadowFrame,
    ShadowTechnique, ViewUniforms, WgslKey,
};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, UVec2, Vec2, Vec3, Vec4};

/// Cases of each filter and map size.
const CASES: usize = 12_288;

/// Weights may be off by a step of the sampler along both axes; the rest is rounding.
const WEIGHT_TOLERANCE: f32 = 2.0 / 256.0 + 1e-5;

/// Half a step of f32 at 1.
const ULP: f64 = 0.5 * f32::EPSILON as f64;

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Case {
    view: ViewUniforms,
    position: Vec4,
    normal: Vec4,
    look: Vec4,
    slope_offset: Vec4,
    row: Vec4,
    weight: Vec4,
}

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Outcome {
    uv: Vec2,
    depth: f32,
    visible: f32,
    slope: Vec2,
    filtered: f32,
    visibility: f32,
    clip: Vec4,
    tap: f32,
    row: f32,
    lit: f32,
    caster_depth: f32,
}

/// `SplitMix64`: numbers without a dependency.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// In [low, high).
    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.next() >> 40) as f32 / (1_u64 << 24) as f32)
    }

    fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::from_array(core::array::from_fn(|_| self.between(-size, size)))
    }
}

#[test]
fn twins_agree() {
    let Some(gpu) = support::gpu() else { return };
    for key in WgslKey::all() {
        // A power of two, and sizes for which 1/size is not exact.
        for side in [64, 61, 7] {
            let worst = compare(&gpu, key, side);
            eprintln!("{key:?} ({side}², {CASES} cases, {}): {worst:?}", gpu.adapter());
        }
    }
}

/// The largest differences that were seen, for the record.
#[derive(Debug, Default)]
struct Worst {
    /// Share of the bound that lookups used.
    lookup: f64,
    /// Difference of a filtered value whose comparisons are beyond doubt.
    weight: f32,
    /// Cases in which a comparison was in doubt.
    doubtful: usize,
    /// Points of a warped map's receivers that lie behind its centre of projection, as both sides say.
    behind: usize,
    /// Points so near the plane through that centre that rounding decides where they go.
    undecided: usize,
}

fn compare(gpu: &Gpu, key: WgslKey, side: u32) -> Worst {
    let filter = key.filter;
    // A map of noise, and frames that were fitted to it.
    let mut random = Random(0xA47A_B00C ^ (u64::from(side) << 8) ^ filter as u64);
    let frames: Vec<ShadowFrame> = (0..16).map(|index| frame(&mut random, key, side, index)).collect();
    let depth: Vec<f32> = (0..side * side).map(|_| noise(&mut random)).collect();
    let descriptor = ShadowMapsDescriptor { label: Some("twins"), key: frames[0].wgsl, map: MapBudget::one(side) };
    let maps = ShadowMaps::new(gpu.device(), &descriptor).unwrap();
    maps.prepare(gpu.queue(), &frames[0]).unwrap();
    fill(gpu, &maps, &frames[0], &depth);
    assert_eq!(read_depth(gpu, &maps).unwrap(), depth, "the adapter stores depths as they are");
    // Run both.
    let cases: Vec<Case> = (0..CASES).map(|_| case(&mut random, &frames, side, &depth)).collect();
    let outcomes = run(gpu, &maps, &cases);
    let map = DepthMap { size: UVec2::splat(side), depth: &depth };
    let mut worst = Worst::default();
    for (case, outcome) in cases.iter().zip(&outcomes) {
        check_lookup(key, case, outcome, &mut worst);
        check_caster(case, outcome);
        check_filters(filter, &map, case, outcome, &mut worst);
        check_visible(key, &map, case, &case.view, outcome.visible, &mut worst);
        check_visible(key, &map, case, &frames[0].uniforms.views[0], outcome.visibility, &mut worst);
        check_visible(key, &map, case, &frames[0].uniforms.views[0], outcome.lit, &mut worst);
    }
    // Bounds that doubt everything would prove nothing.
    assert!(worst.doubtful * 8 < 3 * CASES && worst.undecided * 8 < CASES, "{worst:?}");
    assert!(key.shape == MapShape::Affine || worst.behind * 50 > CASES, "{worst:?}");
    worst
}

/// First-order rounding of `antumbra_lookup`, each operation within two steps and divisions within five.
struct LookupBound {
    uv: [f64; 2],
    depth: f64,
    slope: [f64; 2],
}

/// The lookup of a key, and how far the shader's may be from it; `None` where rounding decides about everything.
fn lookup(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3) -> Option<(Lookup, LookupBound)> {
    let (reach, tap_reach) = (key.filter.reach() as f32, key.filter.tap_reach() as f32);
    match key.shape {
        MapShape::Affine => {
            let twin = antumbra_lookup(view, position, normal, reach, tap_reach);
            Some((twin, LookupBound::of(key.filter, view, position, normal)))
        }
        shape => {
            let twin = antumbra_lookup_projective(shape, view, position, normal, reach, tap_reach);
            let [uv_x, uv_y, depth, slope_x, slope_y] = rounded::lookup_projective(view, position, normal, key.filter)?;
            let mut bound = LookupBound { uv: [uv_x, uv_y], depth, slope: [slope_x, slope_y] };
            if shape == MapShape::ProjectiveDepth {
                bound.divide(view, position, normal, &twin);
            }
            Some((twin, bound))
        }
    }
}

impl LookupBound {
    /// What dividing by w adds: the bounds shrink by the law, which is itself as exact as w and the growth are.
    fn divide(&mut self, view: &ViewUniforms, position: Vec3, normal: Vec3, twin: &Lookup) {
        let at = (position + normal * view.bias[1]).extend(1.0);
        let row = Vec4::from_array(view.w_from_render);
        let w = f64::from(row.dot(at));
        let size = f64::from(row.abs().dot(at.abs()));
        // Growth is at most a half, so that its rounding counts twice; the rest is products.
        let share = 24.0 * ULP * (size / w.abs() + 2.0);
        let law = if w > 0.0 { 1.0 / w } else { 1.0 };
        self.depth = self.depth * law + f64::from(twin.depth.abs()) * share;
        for (bound, slope) in self.slope.iter_mut().zip(twin.slope.to_array()) {
            *bound = *bound * law + f64::from(slope.abs()) * share;
        }
    }

    fn of(filter: Pcf, view: &ViewUniforms, position: Vec3, normal: Vec3) -> Self {
        // A dot product of four terms: seven operations.
        let dot_error = 14.0 * ULP;
        let magnitude = |row: [f32; 4], at: [f64; 3], last: f64| -> f64 {
            let spatial: f64 = (0..3).map(|axis| (f64::from(row[axis]) * at[axis]).abs()).sum();
            spatial + (f64::from(row[3]) * last).abs()
        };
        let n = normal.to_array().map(f64::from);
        let p = position.to_array().map(f64::from);
        let [lost, manual, ..] = view.bias.map(f64::from);
        let [fall_u, fall_v, depth_squared, grazing] = view.texel.map(f64::from);
        // The climb, the fall, its sum, and the cosine.
        let climb = [view.u_from_render, view.v_from_render].map(|row| magnitude(row, n, 0.0));
        let climb_error = climb.map(|size| size * dot_error);
        let fall = [climb[0] * fall_u, climb[1] * fall_v];
        let fall_error = fall.map(|size| size * (dot_error + 2.0 * ULP));
        let (step, step_error) = (fall[0] + fall[1], fall_error[0] + fall_error[1] + (fall[0] + fall[1]) * 2.0 * ULP);
        let cosine = magnitude(view.depth_from_render, n, 0.0);
        let cosine_error = cosine * dot_error;
        let inverse = 1.0 / grazing.max(f64::from(f32::MIN_POSITIVE));
        let inverse_error = inverse * inverse * cosine_error + 5.0 * ULP * inverse;
        // The lift along the normal: it moves the place, and the depth.
        let share_error = inverse * cosine_error + inverse_error * grazing + 6.0 * ULP;
        let reach = filter.reach() + lost;
        let along = reach * step + manual.abs();
        let along_error = reach * (step_error + step * share_error) + 8.0 * ULP * along;
        let row = |row: [f32; 4]| magnitude(row, p, 1.0) * dot_error;
        let moved =
            |size: f64, error: f64, by: f64, by_error: f64| size * by_error + error * by + 4.0 * ULP * size * by;
        let uv = |axis: usize, row_error: f64, whole: f64| {
            row_error
                + moved(climb[axis], climb_error[axis], along, along_error)
                + 2.0 * ULP * (whole + climb[axis] * along)
        };
        // The lift along the light; its sign is in doubt where the cosine's is.
        let exact: f64 = (0..3).map(|axis| f64::from(view.depth_from_render[axis]) * n[axis]).sum();
        let flips = if exact.abs() <= cosine_error { 2.0 } else { 0.0 };
        let fall_depth = depth_squared * inverse;
        let fall_depth_error = depth_squared * (inverse_error + 2.0 * ULP * inverse);
        let tap_reach = filter.tap_reach() + lost;
        let tap = tap_reach * (step_error * fall_depth + step * (fall_depth_error + (flips + 6.0 * ULP) * fall_depth));
        let sum = magnitude(view.depth_from_render, p, 1.0) + cosine * along + tap_reach * step * fall_depth;
        Self {
            uv: [
                uv(0, row(view.u_from_render), magnitude(view.u_from_render, p, 1.0)),
                uv(1, row(view.v_from_render), magnitude(view.v_from_render, p, 1.0)),
            ],
            depth: row(view.depth_from_render)
                + moved(cosine, cosine_error, along, along_error)
                + tap
                + 6.0 * ULP * sum,
            slope: core::array::from_fn(|axis| {
                fall_error[axis] * fall_depth + fall[axis] * (fall_depth_error + (flips + 2.0 * ULP) * fall_depth)
            }),
        }
    }
}

fn check_lookup(key: WgslKey, case: &Case, outcome: &Outcome, worst: &mut Worst) {
    let (position, normal) = (case.position.truncate(), case.normal.truncate());
    let Some((twin, bound)) = lookup(key, &case.view, position, normal) else {
        worst.undecided += 1;
        return;
    };
    worst.behind += usize::from(rounded::behind(&case.view, position, normal));
    for (name, shader, twin, bound) in [
        ("uv.x", outcome.uv.x, twin.uv.x, bound.uv[0]),
        ("uv.y", outcome.uv.y, twin.uv.y, bound.uv[1]),
        ("depth", outcome.depth, twin.depth, bound.depth),
        ("slope.x", outcome.slope.x, twin.slope.x, bound.slope[0]),
        ("slope.y", outcome.slope.y, twin.slope.y, bound.slope[1]),
    ] {
        let difference = (f64::from(shader) - f64::from(twin)).abs();
        // Adapters may flush denormal numbers to zero.
        let bound = bound + f64::from(f32::MIN_POSITIVE);
        assert!(difference <= bound, "{name}: {shader} and {twin}, {difference:e} > {bound:e}: {case:?}");
        worst.lookup = worst.lookup.max(difference / bound);
    }
}

fn check_caster(case: &Case, outcome: &Outcome) {
    let view = &case.view;
    let rows = [view.u_from_render, view.v_from_render, view.w_from_render, view.depth_from_render];
    let matrix = Mat4::from_cols_array_2d(&rows);
    let position = case.position.truncate();
    let twin = antumbra_caster(matrix, position);
    let size = |column: usize| -> f64 {
        let at = position.extend(1.0);
        (0..4).map(|row| f64::from(rows[row][column] * at[row]).abs()).sum()
    };
    for component in 0..4 {
        let difference = f64::from(outcome.clip[component] - twin[component]).abs();
        assert!(difference <= 16.0 * ULP * size(component), "clip {component}: {outcome:?} and {twin}");
    }
    // Linear depth of a vertex.
    let row = Vec4::from_array(view.depth_from_render);
    let difference = f64::from(outcome.caster_depth - antumbra_caster_depth(row, position)).abs();
    let size = f64::from((row * position.extend(1.0)).abs().element_sum());
    assert!(difference <= 16.0 * ULP * size, "caster depth: {outcome:?}, {difference:e}");
}

/// Values of a function of a lookup on all sides of what rounding may do to it.
fn band(look: &Lookup, uv: [f64; 2], depth: f64, value: impl Fn(&Lookup) -> f32) -> (f32, f32) {
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    for x in [-1.0, 0.0, 1.0] {
        for y in [-1.0, 0.0, 1.0] {
            for z in [-1.0, 0.0, 1.0] {
                let moved = look.uv.as_dvec2() + glam::DVec2::new(x * uv[0], y * uv[1]);
                let depth = (f64::from(look.depth) + z * depth) as f32;
                let value = value(&Lookup { uv: moved.as_vec2(), depth, slope: look.slope });
                (low, high) = (low.min(value), high.max(value));
            }
        }
    }
    (low, high)
}

fn check_filters(filter: Pcf, map: &DepthMap, case: &Case, outcome: &Outcome, worst: &mut Worst) {
    let look = Lookup {
        uv: Vec2::new(case.look.x, case.look.y),
        depth: case.look.z,
        slope: Vec2::new(case.slope_offset.x, case.slope_offset.y),
    };
    // Coordinates are scaled by the size and moved by half a texel; depths move along the slope by up to three texels.
    let uv = [look.uv.x, look.uv.y].map(|place| 8.0 * ULP * (f64::from(place).abs() + 4.0 / f64::from(map.size.x)));
    let depth = 8.0 * ULP * f64::from(look.depth.abs() + 4.0 * look.slope.abs().element_sum());
    let mut check = |name: &str, shader: f32, scale: f32, value: &dyn Fn(&Lookup) -> f32| {
        within(name, shader, band(&look, uv, depth, value), scale, case, worst);
    };
    check("filter", outcome.filtered, 1.0, &|look| antumbra_filter(filter, map, look));
    let offset = Vec2::new(case.slope_offset.z, case.slope_offset.w);
    if matches!(filter, Pcf::Box3x3 | Pcf::Box5x5) {
        check("tap", outcome.tap, 1.0, &|look| antumbra_tap(map, look, offset));
    }
    if filter == Pcf::Box5x5 {
        let (x, weight) = (case.row.truncate(), case.weight.truncate());
        let scale = weight.element_sum();
        check("row", outcome.row, scale, &|look| antumbra_box_row(map, look, x, weight, case.row.w));
    }
}

fn check_visible(key: WgslKey, map: &DepthMap, case: &Case, view: &ViewUniforms, shader: f32, worst: &mut Worst) {
    let filter = key.filter;
    let (position, normal) = (case.position.truncate(), case.normal.truncate());
    assert!((0.0..=1.0 + WEIGHT_TOLERANCE).contains(&shader), "{shader} is no share: {case:?}");
    let Some((look, bound)) = lookup(key, view, position, normal) else { return };
    // A place that is in doubt by texels has more values than those around it.
    if bound.uv[0].max(bound.uv[1]) > 0.25 / f64::from(map.size.x) {
        worst.undecided += 1;
        return;
    }
    // Beside the lookup's own error, what the filter does to it.
    let uv = core::array::from_fn(|axis| bound.uv[axis] + 8.0 * ULP * (f64::from(look.uv[axis]).abs() + 1.0));
    let slope = f64::from(look.slope.abs().element_sum());
    let depth =
        bound.depth + 4.0 * (bound.slope[0] + bound.slope[1]) + 8.0 * ULP * (f64::from(look.depth.abs()) + slope);
    let value = |look: &Lookup| antumbra_filter(filter, map, look);
    // The twin itself is the middle of the band.
    let twin = antumbra_visible(key, view, map, position, normal);
    assert_eq!(twin.to_bits(), value(&look).to_bits(), "{case:?}");
    within("visible", shader, band(&look, uv, depth, value), 1.0, case, worst);
}

fn within(name: &str, shader: f32, (low, high): (f32, f32), scale: f32, case: &Case, worst: &mut Worst) {
    let tolerance = WEIGHT_TOLERANCE * scale;
    assert!(
        shader >= low - tolerance && shader <= high + tolerance,
        "{name}: {shader} not in [{low}, {high}]: {case:?}"
    );
    if high - low > tolerance {
        worst.doubtful += 1;
    } else {
        worst.weight = worst.weight.max((low - shader).max(shader - high) / scale);
    }
}

/// A frame over a box of ten units, automatic or manual; warped as a paper does, or by a strength that maps of some
/// thousand texels take, from hardly any on.
fn frame(random: &mut Random, key: WgslKey, side: u32, index: usize) -> ShadowFrame {
    let travel = (DVec3::new(0.0, -1.0, 0.0) + random.vector(0.9).as_dvec3()).normalize();
    let bias = match index % 4 {
        3 => Bias::Manual { depth_world: 0.02, normal_texels: 1.5 },
        _ => Bias::Automatic,
    };
    let warp = match (key.shape, index % 8) {
        (MapShape::Affine, _) => Warp::Focused,
        (_, 0) => Warp::LightSpacePerspective,
        (_, 1) => Warp::Trapezoidal { focus: Focus::default() },
        (_, 2) => Warp::Perspective { pull_back: 0.0 },
        (_, _) => Warp::Fixed { strength: 10.0_f32.powf(random.between(-1.0, 2.5)) },
    };
    // The first frame is the map's own.
    let side = if key.shape != MapShape::Affine && index > 0 { 4096 } else { side };
    let bounds = Aabb::new(DVec3::splat(-5.0), DVec3::splat(5.0));
    let depth = match key.shape {
        MapShape::ProjectiveDepth => DepthLaw::Projective,
        MapShape::Affine | MapShape::Projective => DepthLaw::Linear,
    };
    Remix { encoding: Encoding::Depth(key.filter), bias, warp, depth, guard: false, ..Remix::default() }
        .fit(&FitInput {
            camera: support::camera(UVec2::new(640, 480)),
            light: Light::Directional { travel },
            scene: Scene::within(bounds),
            map: MapBudget::one(side),
            origin: DVec3::ZERO,
            previous: None,
        })
        .unwrap()
}

/// Depths, with both ends among them.
fn noise(random: &mut Random) -> f32 {
    match random.below(16) {
        0 => 0.0,
        1 => 1.0,
        _ => random.between(0.0, 1.0),
    }
}

/// Inputs as engines give them, and hostile ones.
fn case(random: &mut Random, frames: &[ShadowFrame], side: u32, depth: &[f32]) -> Case {
    let view = match random.below(32) {
        0 => ViewUniforms::LIT,
        _ => frames[random.below(frames.len())].uniforms.views[0],
    };
    let position = match random.below(16) {
        0 => random.vector(5_000.0),
        1 => random.vector(12.0),
        // Near the plane through a warp's centre of projection (w = 0), on either side.
        2 | 3 => at_w(&view, random.vector(5.0), random.between(-3.0, 3.0)),
        _ => random.vector(5.0),
    };
    let travel = Vec4::from_array(view.depth_from_render).truncate().normalize_or_zero();
    let unit = random.vector(1.0).normalize_or(Vec3::Y);
    let normal = match random.below(8) {
        0 => Vec3::ZERO,
        1 => -travel,
        // Grazing to within 1e-4, from both sides.
        2 => (travel.cross(unit) + travel * random.between(-1e-4, 1e-4)).normalize_or(Vec3::X),
        3 => [Vec3::X, Vec3::NEG_Y, Vec3::Z][random.below(3)],
        _ => unit,
    };
    let texel = |random: &mut Random| random.below(side as usize) as f32;
    let place = |random: &mut Random| match random.below(8) {
        // Edges and centres of texels, and far outside.
        0 => texel(random) / side as f32,
        1 => (texel(random) + 0.5) / side as f32,
        2 => random.between(-4.0, 5.0),
        _ => random.between(-0.2, 1.2),
    };
    let look_depth = match random.below(8) {
        // Exactly what is stored somewhere, and beyond both ends.
        0 => depth[random.below(depth.len())],
        1 => random.between(-2.0, 3.0),
        _ => random.between(0.0, 1.0),
    };
    let slope = Vec2::new(random.between(-0.1, 0.1), random.between(-0.1, 0.1));
    let offset = Vec2::new(random.between(-3.0, 3.0), random.between(-3.0, 3.0));
    Case {
        view,
        position: position.extend(1.0),
        normal: normal.extend(0.0),
        look: Vec4::new(place(random), place(random), look_depth, 0.0),
        slope_offset: Vec4::new(slope.x, slope.y, offset.x, offset.y),
        row: random.vector(3.0).extend(random.between(-3.0, 3.0)),
        weight: random.vector(0.5).extend(0.0) + Vec4::ONE,
    }
}

/// A position moved to where w is a small number, of either sign; itself where w is the same everywhere.
fn at_w(view: &ViewUniforms, position: Vec3, near: f32) -> Vec3 {
    let row = Vec4::from_array(view.w_from_render);
    let gradient = row.truncate();
    if gradient == Vec3::ZERO {
        return position;
    }
    let w = near.signum() * 10.0_f32.powf(-2.0 * near.abs());
    position + gradient * ((w - row.dot(position.extend(1.0))) / gradient.length_squared())
}

/// Draws depths into a map, texel by texel.
fn fill(gpu: &Gpu, maps: &ShadowMaps, frame: &ShadowFrame, depth: &[f32]) {
    let text = "
        @group(0) @binding(0) var<storage, read> depths: array<f32>;
        @vertex fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
            return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.5, 1.0);
        }
        override side: u32;
        @fragment fn write(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
            return depths[u32(at.y) * side + u32(at.x)];
        }";
    let device = gpu.device();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("fill"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let side = f64::from(maps.depth_texture().size().width);
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("fill"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(gpu::depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("write"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("side", side)],
                ..Default::default()
            },
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let depths = storage(gpu, bytemuck::cast_slice(depth), wgpu::BufferUsages::COPY_DST);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("fill"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: depths.as_entire_binding() }],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = maps.caster_pass(&mut encoder, &frame.views[0], None);
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    // The rim as well, which casters leave alone.
    let whole = maps.depth_texture().size();
    pass.set_viewport(0.0, 0.0, whole.width as f32, whole.height as f32, 0.0, 1.0);
    pass.set_scissor_rect(0, 0, whole.width, whole.height);
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.queue().submit([encoder.finish()]);
}

/// The text of a key: the library, the cases, and calls that only some keys have.
fn text(key: WgslKey) -> String {
    let no_tap = "fn tap(look: AntumbraLookup, offset: vec2f) -> f32 { return 0.0; }";
    let tap = "fn tap(look: AntumbraLookup, offset: vec2f) -> f32 {
        return antumbra_tap(antumbra_map, antumbra_compare, look, offset); }";
    let no_row = "fn row(look: AntumbraLookup, x: vec3f, weight: vec3f, y: f32) -> f32 { return 0.0; }";
    let row = "fn row(look: AntumbraLookup, x: vec3f, weight: vec3f, y: f32) -> f32 {
        return antumbra_box_row(antumbra_map, antumbra_compare, look, x, weight, y); }";
    let [tap, row] = match key.filter {
        Pcf::Point | Pcf::Hardware2x2 => [no_tap, no_row],
        Pcf::Box3x3 => [tap, no_row],
        Pcf::Box5x5 => [tap, row],
    };
    let looks = match key.shape {
        MapShape::Affine => {
            "fn lookup(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
                return antumbra_lookup(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH); }
            fn lit(position: vec3f, normal: vec3f) -> f32 { return antumbra_lit(antumbra_place(position, normal)); }"
        }
        MapShape::Projective | MapShape::ProjectiveDepth => {
            "fn lookup(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
                return antumbra_lookup_projective(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH); }
            fn lit(position: vec3f, normal: vec3f) -> f32 { return antumbra_visibility(position, normal, 1.0); }"
        }
    };
    let library = wgsl::module(key, Bindings { group: 1, first: 0 });
    [library.as_str(), include_str!("twins.wgsl"), looks, tap, row].join("\n")
}

/// Runs the cases on the adapter.
fn run(gpu: &Gpu, maps: &ShadowMaps, cases: &[Case]) -> Vec<Outcome> {
    let text = text(maps.key());
    // The pipeline.
    let device = gpu.device();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("twins"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twins"),
        layout: None,
        module: &module,
        entry_point: Some("run"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    // The buffers.
    let input = storage(gpu, bytemuck::cast_slice(cases), wgpu::BufferUsages::COPY_DST);
    let nothing = vec![0_u8; size_of::<Outcome>() * cases.len()];
    let output = storage(gpu, &nothing, wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC);
    let read = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("outcomes"),
        size: nothing.len() as u64,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let group = |index: u32, entries: &[wgpu::BindGroupEntry]| {
        let layout = pipeline.get_bind_group_layout(index);
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries })
    };
    let data = group(
        0,
        &[
            wgpu::BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
        ],
    );
    let shadows = group(1, &maps.bind_entries(0));
    // Run.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &data, &[]);
    pass.set_bind_group(1, &shadows, &[]);
    pass.dispatch_workgroups(cases.len().div_ceil(64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &read, 0, nothing.len() as u64);
    gpu.queue().submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    bytemuck::pod_collect_to_vec(&read.get_mapped_range(..).unwrap())
}

fn storage(gpu: &Gpu, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("cases"),
        size: bytes.len() as u64,
        usage: usage | wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    gpu.queue().write_buffer(&buffer, 0, bytes);
    buffer
}

/// Hostile coordinates neither overflow nor panic, and finite ones give a share.
#[test]
fn the_twin_survives_anything() {
    let depth = [0.25, 0.5, 0.75, 1.0];
    let map = DepthMap { size: UVec2::splat(2), depth: &depth };
    for place in [1e30, -1e30, 1e10, -1e10, f32::MIN_POSITIVE, -0.0] {
        let value = map.sample_compare(Vec2::new(place, 0.5), 0.4);
        assert!((0.0..=1.0).contains(&value), "{place}: {value}");
    }
    for place in [f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        let _ = map.sample_compare(Vec2::new(place, place), 0.4);
    }
}
