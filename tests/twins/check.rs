//! Each outcome of the shader against its twin's.

use antumbra::encoding::depth::{
    CompareMap, DepthMap, Lookup, antumbra_box_row, antumbra_caster, antumbra_caster_depth, antumbra_filter,
    antumbra_look_noisy, antumbra_tap, antumbra_visible_noisy,
};
use antumbra::encoding::pcf::antumbra_box_row_of_four;
use antumbra::encoding::pixel::{Pixel, pixel_places};
use antumbra::encoding::spread::antumbra_spread;
use antumbra::{Pcf, ViewUniforms, WgslKey};
use glam::{DVec2, Mat4, Vec2, Vec3, Vec4};

use crate::rounded::{self, ULP};
use crate::{Case, Outcome, Worst, bound};

/// Weights may be off by a step of the sampler along both axes; the rest is rounding.
pub(crate) const WEIGHT_TOLERANCE: f32 = 2.0 / 256.0 + 1e-5;

pub(crate) fn lookup(key: WgslKey, case: &Case, outcome: &Outcome, worst: &mut Worst) {
    let (position, normal) = (case.position.truncate(), case.normal.truncate());
    let Some((twin, bound)) = bound::lookup(key, &case.view, position, normal) else {
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

pub(crate) fn caster(case: &Case, outcome: &Outcome) {
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

/// A receiver's lookup in a map, and what rounding may have done to it on its way to a filter.
pub(crate) struct Doubt {
    pub(crate) look: Lookup,
    /// By how much its place may be off, texture coordinates.
    pub(crate) uv: [f64; 2],
    /// By how much its depth may be off.
    pub(crate) depth: f64,
}

impl Doubt {
    /// `None` where rounding decides about everything.
    pub(crate) fn of(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3, noise: f32) -> Option<Self> {
        let (look, bound) = bound::lookup(key, view, position, normal)?;
        let look = Lookup { spread: antumbra_look_noisy(key, view, position, normal, noise).spread, ..look };
        let (turned, reach) = (off_by_turning(key, view, position), key.filter.reach());
        // Beside the lookup's own error, what the filter does to it.
        let uv: [f64; 2] = core::array::from_fn(|axis| {
            bound.uv[axis] + 8.0 * ULP * (f64::from(look.uv[axis]).abs() + 1.0) + turned * f64::from(view.bias[3])
        });
        let slope = f64::from(look.slope.abs().element_sum());
        let depth = bound.depth
            + (reach + 1.0) * (bound.slope[0] + bound.slope[1])
            + 8.0 * ULP * (f64::from(look.depth.abs()) + (0.25 * reach).max(1.0) * slope)
            + turned * slope;
        let (more_uv, more_depth) = match key.filter {
            Pcf::Pixel => bound::pixel(view, position, normal, &look)?,
            _ => ([0.0; 2], 0.0),
        };
        let (uv, depth) = ([uv[0] + more_uv[0], uv[1] + more_uv[1]], depth + more_depth);
        Some(Self { look, uv, depth })
    }

    /// A place that is in doubt by texels has more values than those around it.
    pub(crate) fn is_wide(&self, map: &impl CompareMap) -> bool {
        self.uv[0].max(self.uv[1]) > 0.25 / f64::from(map.size().x)
    }

    /// Least and largest value that a filter may have.
    pub(crate) fn band(&self, filter: Pcf, map: &impl CompareMap) -> (f32, f32) {
        filter_band(filter, map, &self.look, self.uv, self.depth)
    }
}

/// By how much a disc's points may be off on an adapter, as a share of its radius: the cosine and the sine of its turn,
/// and the products with the golden angle. (WGSL promises 2⁻¹¹ of the former; adapters keep this.)
const TURNED_OFF: f64 = 1e-5;

/// By how many texels the points of a filter's disc may be off.
fn off_by_turning(key: WgslKey, view: &ViewUniforms, position: Vec3) -> f64 {
    let radius = key.filter.reach() - key.filter.tap_reach();
    match key.filter {
        Pcf::Disc => radius * TURNED_OFF,
        Pcf::Pcss => radius * (TURNED_OFF + bound::spread(view, position)),
        _ => 0.0,
    }
}

/// Least and largest value that a filter may have: taps over a pixel are in doubt one by one.
fn filter_band(filter: Pcf, map: &impl CompareMap, look: &Lookup, uv: [f64; 2], depth: f64) -> (f32, f32) {
    if filter != Pcf::Pixel {
        return band(look, uv, depth, |look| antumbra_filter(filter, map, look));
    }
    let Pixel { first, second, lift, .. } = look.spread.pixel;
    let taps = [(first, lift.x), (-first, lift.x), (second, lift.y), (-second, lift.y)];
    let tap = |look: &Lookup, step, lift| {
        let [place, _] = pixel_places(look, step, lift);
        map.sample_compare(place.truncate(), place.z.min(1.0))
    };
    let bands = taps.map(|(step, lift)| band(look, uv, depth, |look| tap(look, step, lift)));
    bands.iter().fold((0.0, 0.0), |(low, high), band| (low + 0.25 * band.0, high + 0.25 * band.1))
}

/// Values of a function of a lookup on all sides of what rounding may do to it.
fn band(look: &Lookup, uv: [f64; 2], depth: f64, value: impl Fn(&Lookup) -> f32) -> (f32, f32) {
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    for x in [-1.0, 0.0, 1.0] {
        for y in [-1.0, 0.0, 1.0] {
            for z in [-1.0, 0.0, 1.0] {
                let moved = look.uv.as_dvec2() + DVec2::new(x * uv[0], y * uv[1]);
                let depth = (f64::from(look.depth) + z * depth) as f32;
                let value = value(&Lookup { uv: moved.as_vec2(), depth, ..*look });
                (low, high) = (low.min(value), high.max(value));
            }
        }
    }
    (low, high)
}

pub(crate) fn filters(key: WgslKey, map: &DepthMap, case: &Case, outcome: &Outcome, worst: &mut Worst) {
    let (filter, position, normal) = (key.filter, case.position.truncate(), case.normal.truncate());
    let look = Lookup {
        uv: Vec2::new(case.look.x, case.look.y),
        depth: case.look.z,
        slope: Vec2::new(case.slope_offset.x, case.slope_offset.y),
        spread: antumbra_spread(key, &case.view, position, normal, case.look.w),
    };
    // Coordinates are scaled by the size and moved by half a texel; depths move along the slope by up to a reach.
    let (side, reach, turned) =
        (f64::from(map.size.x), filter.reach().max(3.0) + 1.0, off_by_turning(key, &case.view, position));
    if turned > 0.25 {
        worst.unspread += 1;
        return;
    }
    let uv = [look.uv.x, look.uv.y].map(|place| 8.0 * ULP * (f64::from(place).abs() + reach / side) + turned / side);
    let slope = f64::from(look.slope.abs().element_sum());
    let depth = 8.0 * ULP * (f64::from(look.depth.abs()) + reach * slope) + turned * slope;
    if filter == Pcf::Pixel {
        let Some((more_uv, more_depth)) = bound::pixel(&case.view, position, normal, &look) else {
            worst.unspread += 1;
            return;
        };
        let band = filter_band(filter, map, &look, [uv[0] + more_uv[0], uv[1] + more_uv[1]], depth + more_depth);
        within("filter", outcome.filtered, band, 1.0, case, worst);
        return;
    }
    let mut check = |name: &str, shader: f32, scale: f32, value: &dyn Fn(&Lookup) -> f32| {
        within(name, shader, band(&look, uv, depth, value), scale, case, worst);
    };
    check("filter", outcome.filtered, 1.0, &|look| antumbra_filter(filter, map, look));
    let offset = Vec2::new(case.slope_offset.z, case.slope_offset.w);
    if !matches!(filter, Pcf::Point | Pcf::Hardware2x2) {
        check("tap", outcome.tap, 1.0, &|look| antumbra_tap(map, look, offset));
    }
    if filter == Pcf::Box5x5 {
        let (x, weight) = (case.row.truncate(), case.weight.truncate());
        let scale = weight.element_sum();
        check("row", outcome.row, scale, &|look| antumbra_box_row(map, look, x, weight, case.row.w));
    }
    if filter == Pcf::Box7x7 {
        let (x, weight) = (case.row.truncate().extend(case.row.x), case.weight.truncate().extend(case.weight.x));
        let scale = weight.element_sum();
        check("row", outcome.row, scale, &|look| antumbra_box_row_of_four(map, look, x, weight, case.row.w));
    }
}

pub(crate) fn visible(
    key: WgslKey,
    map: &DepthMap,
    case: &Case,
    view: &ViewUniforms,
    noise: f32,
    shader: f32,
    worst: &mut Worst,
) {
    let filter = key.filter;
    let (position, normal) = (case.position.truncate(), case.normal.truncate());
    assert!((0.0..=1.0 + WEIGHT_TOLERANCE).contains(&shader), "{shader} is no share: {case:?}");
    let Some(doubt) = Doubt::of(key, view, position, normal, noise) else { return };
    if doubt.is_wide(map) {
        worst.undecided += 1;
        return;
    }
    // The twin itself is the middle of the band.
    let twin = antumbra_visible_noisy(key, view, map, position, normal, noise);
    assert_eq!(twin.to_bits(), antumbra_filter(filter, map, &doubt.look).to_bits(), "{case:?}");
    within("visible", shader, doubt.band(filter, map), 1.0, case, worst);
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
