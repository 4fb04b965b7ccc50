//! `Stack`: six cards over the ground, at unequal heights and turned against each other, so that one to six overlap.
//! The hard case of maps that average depths: where several casters lie over each other, moments forget the near ones.
//!
//! 1 unit = 1 m.

use glam::{DMat3, DVec2, DVec3};

use super::scene::SceneModel;
use super::shapes::MeshBuilder;
use super::viewpoints::Viewpoint;

/// Heights of the cards, metres: neighbours 0.35 to 1.9 apart, so that both contacts and gaps are there.
pub const HEIGHTS: [f64; 6] = [0.35, 1.0, 2.2, 3.0, 4.9, 5.6];

/// Half-widths of a card, metres.
const CARD: DVec2 = DVec2::new(3.2, 1.5);

/// Angle between cards that follow each other, radians: six of them fan out over 230°.
const TURN: f64 = 0.8;

/// How far a card's middle is off the stack's, metres.
const OUT: f64 = 0.5;

/// Half-width of the ground, metres.
const GROUND: f64 = 8.0;

/// The scene: the ground, and each card, is an object.
#[must_use]
pub fn stack() -> SceneModel {
    let mut mesh = MeshBuilder::new("stack");
    let level = |mesh: &mut MeshBuilder, at: DVec3, half: DVec2, turn: f64| {
        let axes = DMat3::from_rotation_y(turn);
        let corner = |x: f64, z: f64| at + axes * DVec3::new(x * half.x, 0.0, z * half.y);
        mesh.polygon(&[corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]);
        mesh.end_object();
    };
    level(&mut mesh, DVec3::ZERO, DVec2::splat(GROUND), 0.0);
    for (index, height) in HEIGHTS.into_iter().enumerate() {
        let turn = TURN * index as f64;
        // Each reaches out to another side.
        let out = DMat3::from_rotation_y(2.0 * turn) * DVec3::X * OUT;
        level(&mut mesh, out + DVec3::Y * height, CARD, turn);
    }
    mesh.finish()
}

/// From the side and above, with light 24° off the vertical.
#[must_use]
pub fn stack_viewpoint() -> Viewpoint {
    Viewpoint {
        name: "stack-side".to_owned(),
        eye: DVec3::new(6.5, 8.0, 8.5),
        target: DVec3::new(0.9, 1.7, 0.5),
        up: DVec3::Y,
        fov_y: core::f64::consts::FRAC_PI_4,
        near: 1.0,
        far: 60.0,
        travel: DVec3::new(0.32, -1.0, 0.31).normalize(),
        shadow_distance: 60.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cards above a point along the light, by whether their plane is met within their rim.
    fn above(at: DVec3, travel: DVec3) -> usize {
        let scene = stack();
        let over = |object: &std::ops::Range<usize>| {
            object.clone().any(|triangle| {
                let [a, b, c] = scene.corners(triangle);
                let reach = (a.y - at.y) / -travel.y;
                let met = at - travel * reach;
                let side = |from: DVec3, to: DVec3| (to - from).cross(met - from).y > 0.0;
                reach > 1e-9 && side(a, b) && side(b, c) && side(c, a)
            })
        };
        scene.objects.iter().filter(|object| over(object)).count()
    }

    #[test]
    fn one_to_six_cards_overlap() {
        assert_eq!(stack().objects.len(), 1 + HEIGHTS.len());
        let travel = stack_viewpoint().travel;
        let mut counts = [0; HEIGHTS.len() + 1];
        for cell in 0..100 * 100 {
            let [x, z] = [cell % 100, cell / 100].map(|index| (f64::from(index) / 99.0 * 2.0 - 1.0) * GROUND);
            counts[above(DVec3::new(x, 0.0, z), travel)] += 1;
        }
        assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
    }
}
