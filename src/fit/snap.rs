//! Maps that do not crawl: a window of constant size on a grid that is fixed to the world.
//!
//! # References
//! - Valient, *Stable rendering of cascaded shadow maps*, `ShaderX6`, 2008: a sphere around the frustum, snapped to
//!   texels.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Projection};
use crate::fit::depth_range::rounding;
use crate::report::Why;
use crate::scene::{Aabb, DepthRange};
use crate::warp::bend::Bend;
use crate::warp::window::Window;

/// Whether texels keep their place in the world while the camera moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stabilise {
    /// The tightest fit; edges may crawl when the camera moves.
    #[default]
    Off,
    /// A window of constant size that moves by whole texels: edges never crawl, for a larger window.
    SnapTexels,
}

/// Steps per doubling in which a snapped window may grow. More steps fit tighter but change the texel size, and so let
/// edges jump, more often; fewer waste texels (16: at most 4.5 % of a side).
const STEPS_PER_OCTAVE: f64 = 16.0;

/// The window of a snapped map: square, of a size that depends on the camera's lens and the depths and not on where it
/// looks, placed on a world-fixed grid of texels. `texels` is the number of texels over its side.
///
/// `Err` says why the window of the whole scene, `scene`, serves instead: the frustum has no end, the scene is no
/// larger, or f64 does not resolve texels so far from the world's origin.
pub(crate) fn snapped(
    camera: &Camera,
    depth: DepthRange,
    scene: &Window,
    texels: f64,
    origin: DVec3,
) -> Result<Window, Why> {
    let (centre_depth, radius) = bounding_sphere(&camera.projection, depth);
    if !radius.is_finite() {
        return Err(Why::EndlessFrustum);
    }
    // What f32 loses so far out, in powers of two: the size of a texel must not follow every step of the eye.
    let reach = (camera.eye() - origin).length() + centre_depth.abs() + radius;
    let radius = quantised_up(radius)
        + rounding(reach.log2().ceil().exp2(), DVec3::ZERO)
        + rounding(0.0, quantised_origin(origin));
    // One texel more than the sphere, so that snapping cannot cut it.
    let texel = 2.0 * radius / (texels - 1.0);
    let side = texel * texels;
    if !(texels > 1.0) || scene.size().max_element() <= side {
        return Err(Why::AlreadyStill);
    }
    // The lower corner, in ray coordinates of the world, on whole texels.
    let light = scene.light;
    let centre = camera.eye() + camera.forward() * centre_depth;
    let grid = light.ray(origin).truncate();
    if !resolved(DVec2::splat(texel), grid) {
        return Err(Why::BeyondPrecision);
    }
    let corner = light.ray(centre).truncate() - DVec2::splat(radius);
    let low = (corner / texel).floor() * texel - grid;
    Ok(Window { light, bend: Bend::NONE, low, high: low + side })
}

/// Width and height of a snapped window, together, but for what rounding adds; infinite where the frustum has no end.
pub(crate) fn size(projection: &Projection, depth: DepthRange) -> f64 {
    4.0 * quantised_up(bounding_sphere(projection, depth).1)
}

/// Scene windows grow in steps too, so that a moving object at their border changes the texels seldom.
pub(crate) fn still(window: &Window, texels: f64, origin: DVec3) -> Window {
    let size = window.size();
    if !(texels > 1.0) {
        return *window;
    }
    let texel = DVec2::new(quantised_up(size.x), quantised_up(size.y)) / (texels - 1.0);
    let grid = window.light.ray(origin).truncate();
    if !resolved(texel, grid) {
        return *window;
    }
    let low = ((window.low + grid) / texel).floor() * texel - grid;
    Window { low, high: low + texel * texels, ..*window }
}

/// What f32 loses of positions in a scene and of the origin, in powers of two: the same from frame to frame.
pub(crate) fn steady_margin(bounds: &Aabb, origin: DVec3) -> f64 {
    let reach = (bounds.min - origin).abs().max((bounds.max - origin).abs()).max_element();
    rounding(reach.max(f64::MIN_POSITIVE).log2().ceil().exp2(), DVec3::ZERO) + rounding(0.0, quantised_origin(origin))
}

/// The origin's distance from the world's, up to the next power of two: it may follow the eye, texels must not.
fn quantised_origin(origin: DVec3) -> DVec3 {
    DVec3::splat(origin.length().log2().ceil().exp2())
}

/// Steps of f64 that a texel must have at its place in the world, so that snapping holds to 1/1000 of it. Fewer let
/// maps miss what they are for; more give snapping up nearer to the world's origin.
const STEPS_PER_TEXEL: f64 = 1024.0;

/// Whether f64 tells parts of a texel apart as far out as `grid`, the origin of render space across the light.
fn resolved(texel: DVec2, grid: DVec2) -> bool {
    texel.cmpge(grid.abs() * (f64::EPSILON * STEPS_PER_TEXEL)).all()
}

/// The least power of `2^(1/16)` that is not below a size; 0 stays 0.
fn quantised_up(size: f64) -> f64 {
    if size > 0.0 { ((size.log2() * STEPS_PER_OCTAVE).ceil() / STEPS_PER_OCTAVE).exp2() } else { size }
}

/// Eye depth of the centre, on the view axis, and radius of a sphere around the view volume between two eye depths.
fn bounding_sphere(projection: &Projection, DepthRange { near, far }: DepthRange) -> (f64, f64) {
    match *projection {
        Projection::Perspective { left, right, down, up, .. } => {
            // Tangent of the widest corner. The sphere through the near and the far corners, or the far corners'
            // circle.
            let spread = left.abs().max(right.abs()).powi(2) + down.abs().max(up.abs()).powi(2);
            let centre = (0.5 * (near + far) * (1.0 + spread)).min(far);
            let corner = |depth: f64| (spread * depth * depth + (depth - centre) * (depth - centre)).sqrt();
            (centre, corner(far).max(corner(near)))
        }
        Projection::Orthographic { left, right, down, up, .. } => {
            let spread = left.abs().max(right.abs()).powi(2) + down.abs().max(up.abs()).powi(2);
            let half = 0.5 * (far - near);
            (near + half, (spread + half * half).sqrt())
        }
    }
}
