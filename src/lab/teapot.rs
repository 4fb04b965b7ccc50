//! The Utah teapot on a table: the classic that casts shadows onto itself.
//!
//! Martin Newell's measurements of 1975, in his units: six profiles that are turned about the axis, and
//! handle and spout, whose cross-sections are cubic curves as well. His printed circle has one coordinate of 0.78 where
//! the other fifteen have 0.784; here it is 0.56 of the radius everywhere. As he made it, it is no closed solid: lid
//! and rim leave a gap of a tenth, the spout is open at its tip, and handle and spout end inside the body.
//!
//! # References
//! - F. C. Crow, *The origins of the teapot*, 1987 (the control points).

use glam::{DVec2, DVec3};

use super::scene::SceneModel;
use super::shapes::MeshBuilder;

/// Four control points of a profile: radius and height.
type Profile = [[f64; 2]; 4];

/// A cross-section of handle or spout: inner and outer place (along the pot, height), and half its width.
type Section = ([f64; 2], [f64; 2], f64);

/// Rim, body above and below its widest part, foot, knob, lid: each from its upper or inner end on.
const PROFILES: [Profile; 6] = [
    [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]],
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
    [[1.5, 0.15], [1.5, 0.075], [1.425, 0.0], [0.0, 0.0]],
    [[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]],
    [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]],
];

/// Two curves of four sections each; the middle one belongs to both.
const HANDLE: [Section; 7] = [
    ([-1.6, 2.025], [-1.5, 2.25], 0.3),
    ([-2.3, 2.025], [-2.5, 2.25], 0.3),
    ([-2.7, 2.025], [-3.0, 2.25], 0.3),
    ([-2.7, 1.8], [-3.0, 1.8], 0.3),
    ([-2.7, 1.575], [-3.0, 1.35], 0.3),
    ([-2.5, 1.125], [-2.65, 0.9375], 0.3),
    ([-2.0, 0.9], [-1.9, 0.6], 0.3),
];

/// The same for the spout, whose tip turns inwards.
const SPOUT: [Section; 7] = [
    ([1.7, 1.425], [1.7, 0.6], 0.66),
    ([2.6, 1.425], [3.1, 0.825], 0.66),
    ([2.3, 2.1], [2.4, 2.025], 0.25),
    ([2.7, 2.4], [3.3, 2.4], 0.25),
    ([2.8, 2.475], [3.525, 2.49375], 0.25),
    ([2.9, 2.475], [3.45, 2.5125], 0.15),
    ([2.8, 2.4], [3.2, 2.4], 0.15),
];

/// Where a cubic's inner control points lie on the way to the corner of a quarter circle: Newell's, 0.784 of 1.4.
const ROUND: f64 = 0.56;

/// Half the side of the table, in the teapot's units: long shadows end on it.
const TABLE: f64 = 5.0;

/// Height of the table. The bottom is round and touches the ground in one point that nobody sees; a tenth higher, the
/// table meets the foot all around.
const TABLE_HEIGHT: f64 = 0.1;

/// Sixteen control points, row by row.
type Patch = [[DVec3; 4]; 4];

/// The teapot, every patch in `steps` by `steps` quads, on a table; y is up, the spout points along x.
#[must_use]
pub fn teapot(steps: u32) -> SceneModel {
    let mut mesh = MeshBuilder::new("teapot");
    mesh.terrain(DVec2::splat(-TABLE), DVec2::splat(TABLE), [1, 1], |_, _| TABLE_HEIGHT);
    mesh.end_object();
    for profile in PROFILES {
        for quarter in 0..4 {
            add(&mut mesh, &turned(profile, quarter), steps, false);
        }
    }
    for sections in [HANDLE, SPOUT] {
        for part in [0, 3] {
            for side in [1.0, -1.0] {
                add(&mut mesh, &bent(&sections, part, side), steps, side > 0.0);
            }
        }
    }
    mesh.finish()
}

/// A quarter of what a profile sweeps when it is turned.
fn turned(profile: Profile, quarter: u8) -> Patch {
    // A quarter circle from one axis to the next.
    let (from, to) = match quarter {
        0 => (DVec3::X, DVec3::NEG_Z),
        1 => (DVec3::NEG_Z, DVec3::NEG_X),
        2 => (DVec3::NEG_X, DVec3::Z),
        _ => (DVec3::Z, DVec3::X),
    };
    let arc = [from, from + to * ROUND, to + from * ROUND, to];
    profile.map(|[radius, height]| arc.map(|way| way * radius + DVec3::Y * height))
}

/// Half of a curve of handle or spout: the one on `side` (1 or −1) of the plane that mirrors the pot.
fn bent(sections: &[Section; 7], first: usize, side: f64) -> Patch {
    core::array::from_fn(|row| {
        let (inner, outer, width) = sections[first + row];
        let at = |[x, y]: [f64; 2], width: f64| DVec3::new(x, y, width * side);
        [at(inner, 0.0), at(inner, width), at(outer, width), at(outer, 0.0)]
    })
}

/// Weights of the four control points of a cubic.
fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// A point of a patch.
fn point(patch: &Patch, row: f64, column: f64) -> DVec3 {
    let (rows, columns) = (weights(row), weights(column));
    let along = |points: &[DVec3; 4]| -> DVec3 { (0..4).map(|at| points[at] * columns[at]).sum() };
    (0..4).map(|at| along(&patch[at]) * rows[at]).sum()
}

/// Adds a patch; triangles that shrink to a line at the axis are left out.
fn add(mesh: &mut MeshBuilder, patch: &Patch, steps: u32, backwards: bool) {
    let part = |step: u32| f64::from(step) / f64::from(steps);
    let points: Vec<Vec<DVec3>> =
        (0..=steps).map(|row| (0..=steps).map(|column| point(patch, part(row), part(column))).collect()).collect();
    let indices: Vec<Vec<u32>> =
        points.iter().map(|row| row.iter().map(|position| mesh.vertex(*position)).collect()).collect();
    for row in 0..steps as usize {
        for column in 0..steps as usize {
            let corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)];
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                let at = [a, if backwards { c } else { b }, if backwards { b } else { c }].map(|i: usize| corners[i]);
                let [a, b, c] = at.map(|(row, column)| points[row][column].as_vec3());
                if (b - a).cross(c - a).length() > 0.0 {
                    mesh.triangle(at.map(|(row, column)| indices[row][column]));
                }
            }
        }
    }
    mesh.end_object();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 6.525 from handle to spout, 4 across, 3.15 high, as measured.
    #[test]
    fn it_has_newells_size() {
        let model = teapot(16);
        let pot = SceneModel { triangles: model.triangles[model.objects[0].end..].to_vec(), ..model.clone() };
        let (least, greatest) = pot.bounds().unwrap();
        let expected = [DVec3::new(-3.0, 0.0, -2.0), DVec3::new(3.525, 3.15, 2.0)];
        assert!(least.distance(expected[0]) < 0.02 && greatest.distance(expected[1]) < 0.12, "{least} {greatest}");
    }

    /// Every patch faces outwards: away from the middle of the pot, or of its own bend.
    #[test]
    fn it_faces_outwards() {
        let model = teapot(8);
        for range in &model.objects[1..25] {
            let away: f64 = range
                .clone()
                .map(|triangle| {
                    let [a, b, c] = model.corners(triangle);
                    let middle = (a + b + c) / 3.0;
                    (b - a).cross(c - a).dot(middle - DVec3::Y * 1.2)
                })
                .sum();
            assert!(away > 0.0, "object {range:?}: {away}");
        }
        for bend in [&model.objects[25..29], &model.objects[29..33]] {
            for range in bend {
                let outwards: f64 = range
                    .clone()
                    .map(|triangle| {
                        let [a, b, c] = model.corners(triangle);
                        let middle = (a + b + c) / 3.0;
                        (b - a).cross(c - a).dot(DVec3::Z * middle.z.signum())
                    })
                    .sum();
                assert!(outwards > 0.0, "object {range:?}: {outwards}");
            }
        }
    }
}
