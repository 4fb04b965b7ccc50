//! Detachment ("peter-panning"): how far from the foot of a caster its shadow begins.
//!
//! A *contact* is a pair of 4-neighbours: a valid pixel in true shadow, and one with geometry whose seen side is turned
//! away from the light, such that
//! - the tangent planes of the two meet between the two pixel centres: what is seen there is where two surfaces touch,
//!   not where one hides the other; and
//! - they form a hollow: each point lies in front of the other's plane.
//!
//! There the unlit side of a caster stands on its receiver, and the shadow that it throws begins at the contact. From
//! the pixel in shadow on, away from the caster along the pair's own axis, the lit strip is all pixels that the mask
//! shows more than half lit, as long as they lie on one surface and in true shadow, at most [`STRIP_PX`]. So a strip
//! ends where the true shadow ends: a shadow that is missing altogether is as wide as it was. Along an axis a strip
//! that crosses it at an angle is up to √2 times as wide as across.

use glam::DVec3;

use super::{HALF, MaskError, check};
use crate::lab::case::{Case, CaseLight};
use crate::lab::truth::{JOINS_BELOW, JOINS_RIGHT, NO_TRIANGLE, Truth};

/// How far a strip of light is followed, pixels: more would tell how large shadows are, less hides gross detachment.
pub const STRIP_PX: usize = 32;

/// Where the unlit side of a caster meets its receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// Pixel of the receiver, row by row from the top.
    pub pixel: usize,
    /// Which way the receiver lies from the caster.
    pub away: Away,
}

/// A way along an axis of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Away {
    /// To the left.
    Left,
    /// To the right.
    Right,
    /// Upwards.
    Up,
    /// Downwards.
    Down,
}

/// How far shadows begin from their casters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detachment {
    /// Number of contacts in the picture.
    pub contacts: usize,
    /// Mean width of the lit strip over all contacts, pixels, 0 to [`STRIP_PX`]; 0 without contacts.
    pub mean_px: f64,
    /// Share of the contacts with a strip of at least one pixel, 0 to 1.
    pub share: f64,
}

/// The point that a pixel shows, relative to the eye, and its normal.
#[derive(Clone, Copy)]
struct Seen {
    ray: DVec3,
    at: DVec3,
    normal: DVec3,
}

/// Finds the contacts of a case in its truth.
#[must_use]
pub fn contacts(case: &Case, truth: &Truth) -> Vec<Contact> {
    let (width, count) = (truth.width as usize, truth.valid.len());
    let seen = rays(case, truth);
    let found = |index: usize| {
        let right = !(index + 1).is_multiple_of(width);
        let below = index + width < count;
        let pairs = [
            right.then_some((index, index + 1, [Away::Left, Away::Right])),
            below.then_some((index, index + width, [Away::Up, Away::Down])),
        ];
        let contact = |(a, b, [first, second]): (usize, usize, [Away; 2])| {
            let receives = |pixel: usize| truth.valid[pixel] && truth.centre[pixel] < HALF;
            let casts = |pixel: usize| truth.triangle[pixel] != NO_TRIANGLE && turned(case, &seen(pixel));
            let met = |pixel, away| touch(&seen(a), &seen(b)).then_some(Contact { pixel, away });
            if receives(a) && casts(b) {
                met(a, first)
            } else if receives(b) && casts(a) {
                met(b, second)
            } else {
                None
            }
        };
        pairs.into_iter().flatten().filter_map(contact).collect::<Vec<_>>()
    };
    (0..count).flat_map(found).collect()
}

/// What pixels with geometry show.
fn rays<'a>(case: &Case, truth: &'a Truth) -> impl Fn(usize) -> Seen + 'a {
    let world_from_view = case.world_from_view();
    let [left, right, lower, upper] = case.tangents();
    let (width, height) = (f64::from(truth.width), f64::from(truth.height));
    move |pixel| {
        let (x, y) = ((pixel % truth.width as usize) as f64 + 0.5, (pixel / truth.width as usize) as f64 + 0.5);
        let (across, up) = (left + (right - left) * x / width, upper + (lower - upper) * y / height);
        // The ray's third view coordinate is −1, so its parameter is eye depth.
        let ray = world_from_view.transform_vector3(DVec3::new(across, up, -1.0));
        let normal = DVec3::from_array(truth.normal[pixel].map(f64::from));
        Seen { ray, at: ray * f64::from(truth.depth[pixel]), normal }
    }
}

/// Whether light cannot shine on the side that is seen.
fn turned(case: &Case, seen: &Seen) -> bool {
    let towards_light = match case.light {
        CaseLight::Directional { travel } => -travel,
        CaseLight::Spot { position, .. } | CaseLight::Point { position, .. } => position - (case.camera.eye + seen.at),
    };
    seen.normal.dot(towards_light) <= 0.0
}

/// Whether two planes meet in a hollow between the pixel centres where they are seen.
fn touch(a: &Seen, b: &Seen) -> bool {
    // 1/depth is linear over the picture: the difference of both planes changes sign where they meet.
    let inverse_depth = |plane: &Seen, ray: DVec3| plane.normal.dot(ray) / plane.normal.dot(plane.at);
    let difference = |ray: DVec3| inverse_depth(a, ray) - inverse_depth(b, ray);
    let meet = difference(a.ray) * difference(b.ray) <= 0.0;
    let hollow = (b.at - a.at).dot(a.normal) > 0.0 && (a.at - b.at).dot(b.normal) > 0.0;
    meet && hollow
}

/// Measures the strips of light that a mask has at contacts.
///
/// # Errors
/// [`MaskError`] when the mask does not fit the truth.
pub fn detachment(mask: &[f32], truth: &Truth, contacts: &[Contact]) -> Result<Detachment, MaskError> {
    check(mask, truth)?;
    let strips: Vec<usize> = contacts.iter().map(|contact| strip(mask, truth, *contact)).collect();
    let mean = |sum: usize| sum as f64 / contacts.len().max(1) as f64;
    Ok(Detachment {
        contacts: contacts.len(),
        mean_px: mean(strips.iter().sum()),
        share: mean(strips.iter().filter(|strip| **strip > 0).count()),
    })
}

/// Pixels of the strip at one contact.
fn strip(mask: &[f32], truth: &Truth, contact: Contact) -> usize {
    let width = truth.width as usize;
    let shaded = |pixel: usize| truth.valid[pixel] && truth.centre[pixel] < HALF;
    // The next pixel of the same surface.
    let next = |pixel: usize| {
        let (holder, bit, next) = match contact.away {
            Away::Right => (pixel, JOINS_RIGHT, pixel + 1),
            Away::Down => (pixel, JOINS_BELOW, pixel + width),
            Away::Left => (pixel.checked_sub(1)?, JOINS_RIGHT, pixel - 1),
            Away::Up => (pixel.checked_sub(width)?, JOINS_BELOW, pixel - width),
        };
        (truth.joins[holder] & bit != 0).then_some(next)
    };
    core::iter::successors(Some(contact.pixel), |pixel| next(*pixel))
        .take(STRIP_PX)
        .take_while(|pixel| shaded(*pixel) && mask[*pixel] > HALF)
        .count()
}

#[cfg(test)]
mod tests {
    use super::super::tests::truth;
    use super::*;
    use crate::lab::case::CaseCamera;
    use crate::lab::shapes::MeshBuilder;

    /// Shadow from column 4 to 11; the caster stands to the left of column 4.
    fn scene() -> (Truth, Vec<Contact>) {
        let truth = truth(16, &["1111000000001111"; 3]);
        let contacts = (0..3).map(|row| Contact { pixel: 16 * row + 4, away: Away::Right }).collect();
        (truth, contacts)
    }

    fn lit(columns: &[usize]) -> Vec<f32> {
        let lit = |column: usize| !(4..12).contains(&column) || columns.contains(&column);
        (0..48).map(|pixel| f32::from(u8::from(lit(pixel % 16)))).collect()
    }

    #[test]
    fn strips_begin_at_the_contact_and_end_with_the_shadow() {
        let (truth, contacts) = scene();
        let of = |columns: &[usize]| detachment(&lit(columns), &truth, &contacts).unwrap();
        assert_eq!(of(&[]), Detachment { contacts: 3, mean_px: 0.0, share: 0.0 });
        assert_eq!(of(&[4, 5, 6]), Detachment { contacts: 3, mean_px: 3.0, share: 1.0 });
        // Light further out is a leak, but no detachment.
        assert_eq!(of(&[6, 7]).mean_px, 0.0);
        // A shadow that is missing is as wide as it was: light beyond it is true.
        assert_eq!(of(&[4, 5, 6, 7, 8, 9, 10, 11]).mean_px, 8.0);
        // Half shadow is shadow.
        let half: Vec<f32> = lit(&[]).iter().map(|value| value.max(0.5)).collect();
        assert_eq!(detachment(&half, &truth, &contacts).unwrap().share, 0.0);
    }

    #[test]
    fn strips_follow_the_contact_and_stop_at_other_surfaces() {
        let (mut truth, _) = scene();
        let mask = lit(&[4, 5, 6, 7, 8, 9, 10, 11]);
        let width = |truth: &Truth, pixel: usize, away: Away| strip(&mask, truth, Contact { pixel, away });
        assert_eq!(width(&truth, 9, Away::Left), 6);
        assert_eq!(width(&truth, 4, Away::Down), 3);
        assert_eq!(width(&truth, 32 + 4, Away::Up), 3);
        truth.joins[6] = 0;
        assert_eq!(width(&truth, 4, Away::Right), 3);
        assert_eq!(width(&truth, 9, Away::Left), 3);
        let one = detachment(&mask, &truth, &[Contact { pixel: 4, away: Away::Right }]).unwrap();
        assert_eq!((one.contacts, one.mean_px), (1, 3.0));
        assert_eq!(detachment(&mask, &truth, &[]).unwrap(), Detachment::default());
        assert!(detachment(&mask[1..], &truth, &[]).is_err());
    }

    /// A box on the ground, and one that floats above it: contacts are the foot of the first one's unlit sides.
    #[test]
    fn contacts_are_where_unlit_sides_stand() {
        let travel = DVec3::new(1.0, -1.0, -0.3).normalize();
        let case = |height: f64| {
            let mut mesh = MeshBuilder::new("box");
            mesh.terrain(glam::DVec2::splat(-9.0), glam::DVec2::splat(9.0), [1, 1], |_, _| 0.0);
            mesh.aligned_box(DVec3::new(-1.0, height, -1.0), DVec3::new(1.0, height + 2.0, 1.0));
            let camera = CaseCamera {
                eye: DVec3::new(6.0, 5.0, 4.0),
                target: DVec3::Y,
                up: DVec3::Y,
                fov_y_deg: 50.0,
                near: 0.1,
                far: 50.0,
            };
            let light = CaseLight::Directional { travel };
            let (viewport, folder) = ([120, 90], std::path::PathBuf::new());
            let (name, scene) = ("box".to_owned(), String::new());
            let case = Case { name, scene, camera, light, viewport, shadow_distance: 50.0, folder };
            let truth = Truth::trace(&case, &mesh.finish(), &|| {});
            let found = contacts(&case, &truth);
            (truth, found, case)
        };
        let (truth, standing, case_of) = case(0.0);
        assert!(standing.len() > 15, "{}", standing.len());
        let seen = rays(&case_of, &truth);
        for contact in &standing {
            let at = case_of.camera.eye + seen(contact.pixel).at;
            assert!(at.y.abs() < 1e-3 && at.x > 0.99 && at.x < 1.2 && at.z.abs() < 1.1, "{contact:?} at {at}");
        }
        // A mask without shadow is detached everywhere.
        let none = detachment(&vec![1.0; truth.valid.len()], &truth, &standing).unwrap();
        assert!(none.share == 1.0 && none.mean_px > 5.0, "{none:?}");
        assert_eq!(case(0.7).1, []);
    }
}
