//! What the filter of a map of moments has to know: how wide to blur, where texels lie in the world, and how far
//! receivers are lifted for it.

use glam::{DMat3, DVec2, DVec3, DVec4};

use crate::content::Tile;
use crate::encoding::blur::antumbra_blur_reach;
use crate::encoding::stage::{Encoding, Prefilter, Radius};
use crate::fit::bias::Bias;
use crate::fit::snap::{self, Stabilise};
use crate::fit::view::{Fitter, Texels};
use crate::focus::FocusBody;
use crate::frame::{ShadowFrame, ViewUniforms};
use crate::light_space::LightSpace;
use crate::report::{Part, Why};
use crate::texel::{BlurUniforms, MomentKind};

/// Shortest extent across the light by which a world radius is divided, world units: what is thinner is blurred as much
/// as can be.
const THINNEST: f64 = 1e-30;

/// Below every w in view, as in the shader.
const LEAST_W: f64 = 1e-6;

/// Loss of variance, share of the depth range squared, from which a format is said to lose shadows: a standard
/// deviation of 3 % of the range. Lower would warn of 16-bit integers, whose penumbras are a hundredth as deep.
const MUCH_LOST: f32 = 1e-3;

/// What a filter reads of the map, where it lies in the world.
pub(crate) struct Placed<'a> {
    /// Rows of u, v (times w) and w.
    pub(crate) rows: &'a [DVec4; 3],
    /// U, V and W of the world steps from texel to texel.
    pub(crate) across: [DVec3; 3],
    /// Across the light.
    pub(crate) light: &'a LightSpace,
    /// Size of a texel where w is 1, world units.
    pub(crate) texel: DVec2,
    /// Vertices of the body of receivers, render space.
    pub(crate) receivers: &'a [DVec3],
}

impl Placed<'_> {
    /// Most texels over a pixel that any receiver sees: no less, and in uniform maps no more.
    fn most_texels(&self, pixel: DVec4) -> f64 {
        let at = |row: DVec4| self.receivers.iter().map(move |vertex| row.dot(vertex.extend(1.0)));
        let least_w = at(self.rows[2]).fold(f64::INFINITY, f64::min).max(LEAST_W);
        (at(pixel).fold(0.0, f64::max) / (least_w * least_w.sqrt())).max(f64::MIN_POSITIVE)
    }
}

impl Fitter<'_> {
    /// The texels of a map of that side around a body: with as much border as its blur reads.
    pub(crate) fn texels_for(&self, body: &FocusBody, side: u32) -> Texels {
        let Encoding::Moments(prefilter) = self.encoding else { return self.texels.of_side(side) };
        let radius = match prefilter.radius {
            Radius::Texels(radius) => f64::from(radius),
            Radius::World(radius) => f64::from(radius) * f64::from(side) / self.extent(body).max(THINNEST),
        };
        let radius = radius.min(f64::from(prefilter.widest())) as f32;
        self.texels.of_side(side).blurred(antumbra_blur_reach(radius, prefilter.is_bell()).unsigned_abs())
    }

    /// About the shorter side of the window that will be laid around a body, world units. Of maps that stand still it
    /// stands still too.
    fn extent(&self, body: &FocusBody) -> f64 {
        let snapped = 0.5 * snap::size(&self.input.camera.projection, body.depth);
        if self.how.stabilise == Stabilise::SnapTexels && snapped.is_finite() {
            return snapped;
        }
        let light = LightSpace::fixed(self.travel);
        let places = || body.vertices.iter().map(|vertex| light.ray(*vertex).truncate());
        let low = places().fold(DVec2::INFINITY, DVec2::min);
        (places().fold(DVec2::NEG_INFINITY, DVec2::max) - low).min_element()
    }

    /// Writes what lookups need of the filter, and gives what its passes need.
    pub(crate) fn blur(
        &self,
        prefilter: &Prefilter,
        placed: &Placed,
        texels: &Texels,
        uniforms: &mut ViewUniforms,
        frame: &mut ShadowFrame,
    ) -> BlurUniforms {
        let Placed { rows, across, light, texel, .. } = *placed;
        // One over w: the last row of the inverse of what takes places across the light to (u w, v w, w).
        let of = |row: DVec4| DVec3::new(row.truncate().dot(light.p()), row.truncate().dot(light.q()), row.w);
        let place_from_texture = DMat3::from_cols(of(rows[0]), of(rows[1]), of(rows[2])).transpose().inverse();
        let row = |row: DVec3| row.extend(0.0).as_vec4().to_array();
        let [across_u, across_v, across_w] = across.map(row);
        let radius = match prefilter.radius {
            Radius::Texels(radius) => -radius,
            Radius::World(radius) => radius,
        };
        // Lift receivers by what of the blur reaches nearer.
        let widest = match prefilter.radius {
            Radius::Texels(radius) => f64::from(radius),
            Radius::World(radius) => f64::from(radius) / texel.min_element(),
        };
        let most = f64::from(prefilter.widest());
        if widest > most {
            let radius = most * texel.min_element();
            frame.leave_out(Part::Blur(self.index), Why::BlurTooWide { radius });
        }
        uniforms.bias[0] += (self.lifted(prefilter) * widest.min(f64::from(texels.kernel()))) as f32;
        uniforms.moments[3] = radius;
        self.write_level(prefilter, placed, uniforms, frame);
        let corner = self.tile.corner;
        BlurUniforms {
            tile: [corner.x, corner.y, self.tile.side, self.tile.of],
            across_u,
            across_v,
            across_w,
            inverse_w: row(place_from_texture.row(2)),
            radius,
            bell: prefilter.is_bell().into(),
            first_term: 0,
            stride: 1,
        }
    }

    /// How far receivers are lifted for a blur, as a share of its radius: not at all where that is done by hand.
    fn lifted(&self, prefilter: &Prefilter) -> f64 {
        if self.bias == Bias::Automatic { prefilter.lifted() } else { 0.0 }
    }

    /// Which level of the mip chain is read: texels over a pixel, linear in position for perspective views. Levels in
    /// which no pixel sees more than a texel are left out.
    fn write_level(
        &self,
        prefilter: &Prefilter,
        placed: &Placed,
        uniforms: &mut ViewUniforms,
        frame: &mut ShadowFrame,
    ) {
        let camera = &self.input.camera;
        let pixels = camera.pixels_per_unit() * placed.texel.element_product().sqrt();
        let pixel = if camera.projection.spreads() {
            let forward = camera.forward();
            forward.extend(forward.dot(self.input.origin - camera.eye()))
        } else {
            DVec4::W
        } / pixels;
        let (last, halved) = (prefilter.moments.last_level(self.tile.of), self.whole_levels());
        let texels = placed.most_texels(pixel);
        let wanted = texels.log2().ceil().clamp(0.0, f64::from(last)) as u32;
        let read = wanted.min(halved);
        if read > 0 {
            uniforms.pixel_from_render = pixel.as_vec4().to_array();
        }
        if wanted > halved {
            frame.leave_out(Part::Levels(self.index), Why::SidesAreOdd { wanted, halved });
        } else if wanted == 0 && last > 0 {
            frame.leave_out(Part::Levels(self.index), Why::TexelsAreLarger { texels });
        }
        uniforms.moments = [prefilter.dark, read as f32, self.lifted(prefilter) as f32, uniforms.moments[3]];
    }

    /// Last level in which the tile is whole texels: beyond it they are shared with other maps, or where a level of an
    /// odd side was halved no longer lie where they are looked up.
    fn whole_levels(&self) -> u32 {
        let Tile { corner, side, of, .. } = self.tile;
        (corner.x | corner.y | side | of).trailing_zeros()
    }
}

/// Says what a format of moments loses.
pub(crate) fn report(encoding: &Encoding, frame: &mut ShadowFrame) {
    let Encoding::Moments(Prefilter { moments, bell, .. }) = *encoding else { return };
    if moments.is_summed() && (bell || moments.mips) {
        frame.leave_out(Part::Light, Why::SumsAreBoxes);
    }
    if moments.kind() == MomentKind::Variance && moments.variance_loss() >= MUCH_LOST {
        frame.leave_out(Part::Light, Why::FormatLoses { depth: f64::from(moments.variance_loss()).sqrt() });
    }
}
