//! The maps behind the pictures: as the light sees the scene, and as the camera sees the maps.

use antumbra::lab::case::Case;
use antumbra::lab::cpu::Visible;
use antumbra::lab::projection::clip_from_render;
use antumbra::lab::raster::{DepthMode, DepthTarget, RasterPass, rasterise};
use antumbra::lab::serving::serving;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::{ShadowFrame, ShadowTechnique, ShadowView};
use glam::{DVec3, DVec4};

use crate::montage::Picture;
use crate::programme::{PLUS, SSM, TSM, main_techniques};

/// Side of the maps that are drawn to be looked at, texels: twice that of their pictures.
const SIDE: u32 = 600;

/// Greys of what is nearest to the light, and of what is farthest; and where nothing is drawn. 8-bit sRGB.
const GREYS: [f32; 2] = [24.0, 224.0];
const NOTHING: [u8; 3] = [176, 204, 232];

/// Lines, and what is seen; 8-bit sRGB.
const FRUSTUM: [u8; 3] = [255, 255, 255];
const WINDOW: [u8; 3] = [176, 32, 224];
const SEEN: [u8; 3] = [255, 150, 40];

/// What the first map serves, and the second and so on; and what none does.
const SERVED: [[u8; 3]; 4] = [[255, 160, 64], [96, 160, 255], [110, 220, 110], [200, 130, 240]];
const UNSERVED: [u8; 3] = [150, 150, 150];

/// Half the width of a line, pixels.
const PEN: f64 = 1.0;

/// Corners of the faces of clip space, and which of them an edge joins.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// A case from both sides.
pub(crate) struct MapSight<'a> {
    subject: &'a Subject,
    setting: Setting,
    visible: Visible,
    seen: Vec<DVec3>,
}

impl<'a> MapSight<'a> {
    pub(crate) fn new(subject: &'a Subject, case: &Case) -> Self {
        let setting = Setting::of(case);
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        let seen = setting.visible_points(subject);
        Self { subject, setting, visible, seen }
    }

    /// The light's view with what is seen in it, and three maps.
    pub(crate) fn maps(&self) -> Result<Vec<(String, Picture)>, String> {
        let (standard, trapezoid, first) = (self.fitted(SSM, SIDE)?, self.fitted(TSM, SIDE)?, self.fitted(PLUS, SIDE)?);
        let view = |frame: &ShadowFrame| frame.views.first().cloned().ok_or("no map");
        let [standard_view, trapezoid_view, first_view] = [view(&standard)?, view(&trapezoid)?, view(&first)?];
        let mut looked_at = self.depths(&standard, &standard_view);
        self.mark_seen(&mut looked_at, &standard_view);
        self.outline_frustum(&mut looked_at, &standard_view);
        outline_window(&mut looked_at, &standard_view, &trapezoid_view);
        let maps = [
            ("the light", looked_at),
            ("SSM", self.depths(&standard, &standard_view)),
            ("TSM", self.depths(&trapezoid, &trapezoid_view)),
            ("SMRA plus 1", self.depths(&first, &first_view)),
        ];
        Ok(maps.into_iter().map(|(name, picture)| (name.to_owned(), picture.halved())).collect())
    }

    /// A picture in the colours of the maps that serve it.
    pub(crate) fn served(&self, name: &str, size: u32, picture: &Picture) -> Result<Picture, String> {
        let frame = self.fitted(name, size)?;
        let Setting { camera, origin, .. } = &self.setting;
        Ok(picture.tinted(|pixel| {
            let hit = self.visible.pixel(pixel)?;
            let serving = serving(&frame, camera, *origin, hit.position, hit.normal);
            Some(serving.and_then(|view| SERVED.get(view).copied()).unwrap_or(UNSERVED))
        }))
    }

    fn fitted(&self, name: &str, side: u32) -> Result<ShadowFrame, String> {
        let techniques = main_techniques();
        let (_, remix) = techniques.iter().find(|(known, _)| *known == name).ok_or_else(|| format!("no {name}"))?;
        let input = self.setting.input(self.subject, &self.seen, remix.wgsl_key(), side);
        remix.fit(&input).map_err(|error| error.to_string())
    }

    /// A map of depths in greys, those of what is in it stretched to all there are.
    fn depths(&self, frame: &ShadowFrame, view: &ShadowView) -> Picture {
        let mut target = DepthTarget::new(SIDE, SIDE, DepthMode::LessEqual);
        let pass = RasterPass {
            clip_from_render: view.clip_from_render,
            depth_from_render: frame.wgsl.shape.writes_depth().then_some(view.depth_from_render),
            origin: self.setting.origin,
        };
        rasterise(&mut target, &self.subject.model, &self.subject.model.objects, &pass);
        let empty = target.mode.cleared();
        let drawn = target.depth.iter().filter(|depth| **depth < empty);
        let [low, high] = drawn.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], d| [low.min(*d), high.max(*d)]);
        let grey = |depth: &f32| {
            let share = (depth - low) / (high - low).max(f32::MIN_POSITIVE);
            if *depth < empty { [(GREYS[0] + (GREYS[1] - GREYS[0]) * share).round() as u8; 3] } else { NOTHING }
        };
        let side = SIDE as usize;
        Picture { width: side, height: side, pixels: target.depth.iter().map(grey).collect() }
    }

    /// Colours the texels of what the camera sees.
    fn mark_seen(&self, picture: &mut Picture, view: &ShadowView) {
        let mut seen = vec![false; picture.pixels.len()];
        for hit in self.visible.iter() {
            let [x, y] = at(view, hit.position.extend(1.0));
            if let Some(pixel) = picture.pixel_at(x, y) {
                seen[pixel] = true;
            }
        }
        *picture = picture.tinted(|pixel| seen[pixel].then_some(SEEN));
    }

    /// Draws the edges of the camera's frustum.
    fn outline_frustum(&self, picture: &mut Picture, view: &ShadowView) {
        let render_from_clip = clip_from_render(&self.setting.camera, self.setting.origin).inverse();
        // Depth is reversed: 1 at the near plane.
        let corner = |[x, y]: [f64; 2], depth: f64| at(view, render_from_clip * DVec4::new(x, y, depth, 1.0));
        for index in 0..4 {
            let (a, b) = (CORNERS[index], CORNERS[(index + 1) % 4]);
            for [from, to] in [[(a, 1.0), (b, 1.0)], [(a, 0.0), (b, 0.0)], [(a, 1.0), (a, 0.0)]] {
                picture.draw_line(corner(from.0, from.1), corner(to.0, to.1), PEN, FRUSTUM);
            }
        }
    }
}

/// Draws what another map covers: all points of a light ray are in one texel of both, whatever their depth.
fn outline_window(picture: &mut Picture, view: &ShadowView, other: &ShadowView) {
    let render_from_clip = other.clip_from_render.as_dmat4().inverse();
    let corners = CORNERS.map(|[x, y]| at(view, render_from_clip * DVec4::new(x, y, 0.5, 1.0)));
    for index in 0..4 {
        picture.draw_line(corners[index], corners[(index + 1) % 4], PEN, WINDOW);
    }
}

/// Where a homogeneous point of render space is in a map's picture, pixels.
fn at(view: &ShadowView, point: DVec4) -> [f64; 2] {
    let clip = view.clip_from_render.as_dmat4() * point;
    let side = f64::from(SIDE);
    [(0.5 + 0.5 * clip.x / clip.w) * side, (0.5 - 0.5 * clip.y / clip.w) * side]
}
