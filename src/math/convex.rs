//! Exact clipping of a convex body by half-spaces, without allocation and with a proven capacity.
//!
//! The body is kept as a graph: vertices, and edges that know their two faces. A vertex is either inside a plane or
//! outside it, never "on" it, so that every face a plane cuts loses exactly one chain of vertices and gains exactly one
//! edge, whatever the rounding of the distances: the *combinatorics* are exact even where coordinates are rounded.
//!
//! Capacity. Cuts keep every vertex at degree three (a new vertex ends one cut edge and two edges of the new face), so
//! 2E = 3V, and with Euler's V − E + F = 2 a body of F faces has V = 2F − 4 vertices and E = 3F − 6 edges, or fewer
//! where faces have vanished. A frustum (6 faces) and a box (6) make at most 20 vertices; the shadow of a box adds at
//! most 9 faces, and a slice of it 2: 23 faces, 42 vertices, 63 edges.
//!
//! Vertices are homogeneous with w ≥ 0, so that a frustum without far plane is an ordinary body with four vertices at
//! infinity.

use arrayvec::ArrayVec;
use glam::{DVec3, DVec4};

/// Most faces of a body: frustum (6), box (6), shadow of a box (9), slice (2).
pub(crate) const MAX_FACES: usize = 23;
/// Most vertices: 2F − 4.
pub(crate) const MAX_VERTICES: usize = 2 * MAX_FACES - 4;
/// Most edges: 3F − 6.
pub(crate) const MAX_EDGES: usize = 3 * MAX_FACES - 6;

/// A half-space `dot(normal, x) + offset >= 0`, as `(normal, offset)`.
pub(crate) type HalfSpace = DVec4;

#[derive(Clone, Copy, Debug)]
struct Edge {
    vertices: [u8; 2],
    faces: [u8; 2],
}

/// A convex polyhedron.
#[derive(Clone, Debug)]
pub(crate) struct Convex {
    vertices: ArrayVec<DVec4, MAX_VERTICES>,
    edges: ArrayVec<Edge, MAX_EDGES>,
    faces: u8,
}

/// Edges of a hexahedron whose corners are numbered by bits (x = 1, y = 2, z = 4), with the two faces of each
/// (faces: 0 −x, 1 +x, 2 −y, 3 +y, 4 −z, 5 +z).
const HEXAHEDRON: [([u8; 2], [u8; 2]); 12] = [
    ([0, 1], [2, 4]),
    ([2, 3], [3, 4]),
    ([4, 5], [2, 5]),
    ([6, 7], [3, 5]),
    ([0, 2], [0, 4]),
    ([1, 3], [1, 4]),
    ([4, 6], [0, 5]),
    ([5, 7], [1, 5]),
    ([0, 4], [0, 2]),
    ([1, 5], [1, 2]),
    ([2, 6], [0, 3]),
    ([3, 7], [1, 3]),
];

impl Convex {
    /// The hexahedron with these corners, numbered by bits: bit 0 is x (left/right), bit 1 is y, bit 2 is z (near/far).
    /// Corners are homogeneous: w = 1 for a point, w = 0 for a direction.
    pub(crate) fn hexahedron(corners: [DVec4; 8]) -> Self {
        let edges = HEXAHEDRON.iter().map(|&(vertices, faces)| Edge { vertices, faces }).collect();
        Self { vertices: corners.into_iter().collect(), edges, faces: 6 }
    }

    /// Vertices that are points; after clipping by any bounded body these are all of them.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.vertices.iter().filter(|vertex| vertex.w > 0.0).map(|vertex| vertex.truncate() / vertex.w)
    }

    /// Edges between vertices that are points, by their ends.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let ends = self.edges.iter().map(|edge| edge.vertices.map(|index| self.vertices[usize::from(index)]));
        ends.filter(|ends| ends.iter().all(|end| end.w > 0.0)).map(|ends| ends.map(|end| end.truncate() / end.w))
    }

    /// True when nothing is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Number of vertices.
    #[cfg(test)]
    pub(crate) fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Keeps the part inside `plane`; says whether anything was cut away.
    pub(crate) fn clip(&mut self, plane: HalfSpace) -> bool {
        // Classify the vertices.
        let mut distance = [0.0; MAX_VERTICES];
        let mut outside = 0;
        for (slot, vertex) in distance.iter_mut().zip(&self.vertices) {
            *slot = plane.dot(*vertex);
            outside += usize::from(!inside(*slot));
        }
        if outside == 0 {
            return false;
        }
        if outside == self.vertices.len() {
            self.vertices.clear();
            self.edges.clear();
            return true;
        }
        self.cut(plane_face(self.faces), &distance);
        self.faces += 1;
        true
    }

    /// Replaces the outside part by the new face `cap`.
    fn cut(&mut self, cap: u8, distance: &[f64; MAX_VERTICES]) {
        // Move the vertices that stay to the front of a new list.
        let mut vertices = ArrayVec::<DVec4, MAX_VERTICES>::new();
        let mut renamed = [0_u8; MAX_VERTICES];
        for (index, vertex) in self.vertices.iter().enumerate() {
            if inside(distance[index]) {
                renamed[index] = narrow(vertices.len());
                vertices.push(*vertex);
            }
        }
        // Shorten the edges that cross; remember, for each face they cut, the vertex where they left it.
        let mut edges = ArrayVec::<Edge, MAX_EDGES>::new();
        let mut open = [None::<u8>; MAX_FACES];
        for edge in &self.edges {
            let [a, b] = edge.vertices.map(usize::from);
            match (inside(distance[a]), inside(distance[b])) {
                (false, false) => {}
                (true, true) => edges.push(Edge { vertices: [renamed[a], renamed[b]], ..*edge }),
                (a_stays, _) => {
                    let (stay, leave) = if a_stays { (a, b) } else { (b, a) };
                    let new = narrow(vertices.len());
                    let point = crossing(self.vertices[stay], distance[stay], self.vertices[leave], distance[leave]);
                    if vertices.try_push(point).is_err() {
                        continue; // unreachable by the proof above; never a panic
                    }
                    let _ = edges.try_push(Edge { vertices: [renamed[stay], new], ..*edge });
                    // Join it to the other crossing of each of its faces: an edge of the cap.
                    for face in edge.faces {
                        match open[usize::from(face)].take() {
                            None => open[usize::from(face)] = Some(new),
                            Some(first) => {
                                let _ = edges.try_push(Edge { vertices: [first, new], faces: [face, cap] });
                            }
                        }
                    }
                }
            }
        }
        // Only what is in use is copied: assigning the lists would copy their capacity.
        self.vertices.clear();
        self.edges.clear();
        let _ = self.vertices.try_extend_from_slice(&vertices);
        let _ = self.edges.try_extend_from_slice(&edges);
    }
}

/// On the plane counts as inside; NaN counts as outside.
fn inside(distance: f64) -> bool {
    distance >= 0.0
}

fn narrow(index: usize) -> u8 {
    index as u8
}

fn plane_face(faces: u8) -> u8 {
    faces.min(narrow(MAX_FACES - 1))
}

/// The point of the edge from `stay` (distance ≥ 0) to `leave` (distance < 0) on the plane, in homogeneous coordinates.
fn crossing(stay: DVec4, stay_distance: f64, leave: DVec4, leave_distance: f64) -> DVec4 {
    let point = stay * -leave_distance + leave * stay_distance;
    // A stay vertex on the plane itself is the crossing, whatever the products round to.
    if stay_distance == 0.0 {
        return stay;
    }
    let point = if point.w > 0.0 { point / point.w } else { point.normalize_or_zero() };
    if point.is_finite() { point } else { stay }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cube(low: DVec3, high: DVec3) -> Convex {
        Convex::hexahedron(core::array::from_fn(|bits| {
            DVec3::new(
                if bits & 1 == 0 { low.x } else { high.x },
                if bits & 2 == 0 { low.y } else { high.y },
                if bits & 4 == 0 { low.z } else { high.z },
            )
            .extend(1.0)
        }))
    }

    #[test]
    fn a_corner_cut_off_a_cube() {
        let mut body = cube(DVec3::ZERO, DVec3::ONE);
        // x + y + z <= 2.5 removes the corner (1, 1, 1) and leaves three vertices in its place.
        assert!(body.clip(DVec4::new(-1.0, -1.0, -1.0, 2.5)));
        assert_eq!(body.vertex_count(), 10);
        let on_plane = body.points().filter(|p| (p.element_sum() - 2.5).abs() < 1e-15).count();
        assert_eq!(on_plane, 3);
    }

    #[test]
    fn nothing_left_and_nothing_cut() {
        let mut body = cube(DVec3::ZERO, DVec3::ONE);
        assert!(!body.clip(DVec4::new(1.0, 0.0, 0.0, 0.0)));
        assert!(body.clip(DVec4::new(1.0, 0.0, 0.0, -1.5)));
        assert!(body.is_empty());
        assert!(body.clip(DVec4::new(0.0, 1.0, 0.0, 0.0)) || body.is_empty());
    }

    #[test]
    fn vertices_at_infinity_are_clipped_to_finite_ones() {
        // A frustum without far plane, looking along -z.
        let mut body = Convex::hexahedron(core::array::from_fn(|bits| {
            let x = if bits & 1 == 0 { -1.0 } else { 1.0 };
            let y = if bits & 2 == 0 { -1.0 } else { 1.0 };
            DVec4::new(x, y, -1.0, if bits & 4 == 0 { 1.0 } else { 0.0 })
        }));
        assert_eq!(body.points().count(), 4);
        body.clip(DVec4::new(0.0, 0.0, 1.0, 10.0));
        assert_eq!(body.points().count(), 8);
        assert!(body.points().all(|p| p.z >= -10.0 - 1e-12 && p.x.abs() <= 10.0 + 1e-12));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Euler's formula holds after every cut, degree three is kept, and the capacity of 2F − 4 is never exceeded.
        #[test]
        fn combinatorics_survive_any_planes(
            planes in prop::collection::vec(
                (prop::array::uniform3(-1.0..1.0_f64), prop_oneof![-1.0..1.0_f64, Just(0.0), Just(1.0)]), 0..15),
        ) {
            let mut body = cube(-DVec3::ONE, DVec3::ONE);
            for (index, (normal, offset)) in planes.iter().enumerate() {
                body.clip(DVec3::from_array(*normal).extend(*offset));
                if body.is_empty() {
                    break;
                }
                let faces = 6 + index + 1;
                prop_assert!(body.vertex_count() <= 2 * faces - 4);
                prop_assert_eq!(2 * body.edges.len(), 3 * body.vertex_count());
                // Faces that still have edges: V − E + F = 2.
                let mut seen = [false; MAX_FACES];
                body.edges.iter().flat_map(|edge| edge.faces).for_each(|face| seen[usize::from(face)] = true);
                let alive = seen.iter().filter(|&&seen| seen).count();
                prop_assert_eq!(body.vertex_count() + alive, body.edges.len() + 2);
            }
        }

        /// Against brute force: a point of the cube is in the clipped body iff it is inside all planes; every vertex of
        /// the body satisfies all planes; and the body's support in any direction is that of the brute-force vertex
        /// set.
        #[test]
        fn support_matches_brute_force(
            planes in prop::collection::vec((prop::array::uniform3(-1.0..1.0_f64), -0.6..1.0_f64), 0..9),
            direction in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let mut body = cube(-DVec3::ONE, DVec3::ONE);
            let mut all: Vec<DVec4> = (0..3).flat_map(|axis| [1.0, -1.0].map(|sign| {
                let mut plane = DVec4::ZERO;
                plane[axis] = sign;
                plane.w = 1.0;
                plane
            })).collect();
            for (normal, offset) in &planes {
                let plane = DVec3::from_array(*normal).extend(*offset);
                body.clip(plane);
                all.push(plane);
            }
            let direction = DVec3::from_array(direction);
            let brute = brute_force_vertices(&all).into_iter().map(|v| v.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
            let ours = body.points().map(|v| v.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
            for vertex in body.points() {
                for plane in &all {
                    prop_assert!(plane.dot(vertex.extend(1.0)) > -1e-9);
                }
            }
            if brute.is_finite() || ours.is_finite() {
                prop_assert!((brute - ours).abs() < 1e-6 || brute == f64::NEG_INFINITY && body.vertex_count() < 64);
            }
        }
    }

    /// All intersections of three planes that satisfy the others.
    fn brute_force_vertices(planes: &[DVec4]) -> Vec<DVec3> {
        let mut found = Vec::new();
        for (i, a) in planes.iter().enumerate() {
            for (j, b) in planes.iter().enumerate().skip(i + 1) {
                for c in planes.iter().skip(j + 1) {
                    let normals = glam::DMat3::from_cols(a.truncate(), b.truncate(), c.truncate()).transpose();
                    if normals.determinant().abs() < 1e-9 {
                        continue;
                    }
                    let point = normals.inverse() * -DVec3::new(a.w, b.w, c.w);
                    if planes.iter().all(|plane| plane.dot(point.extend(1.0)) > -1e-9) {
                        found.push(point);
                    }
                }
            }
        }
        found
    }

    /// The bound of 2·12 − 4 = 20 for a frustum and a box is reached, not only respected.
    #[test]
    fn frustum_and_box_reach_twenty_vertices() {
        let mut most = 0;
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..200_000 {
            // A slice of a frustum about as large as the box, turned and shifted a little against it.
            let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, random() * 6.3, random() * 6.3, random() * 6.3);
            let distance = 2.0 + 4.0 * random();
            let shift = (DVec3::new(random(), random(), random()) - 0.5) * 0.4;
            let (half_depth, half_width) = (0.9 + 0.4 * random(), 0.9 + 0.4 * random());
            let mut body = Convex::hexahedron(core::array::from_fn(|bits| {
                let depth = if bits & 4 == 0 { distance - half_depth } else { distance + half_depth };
                let x = if bits & 1 == 0 { -half_width } else { half_width } * depth / distance;
                let y = if bits & 2 == 0 { -half_width } else { half_width } * depth / distance;
                (shift + turn * DVec3::new(x, y, distance - depth)).extend(1.0)
            }));
            for axis in 0..3 {
                for sign in [1.0, -1.0] {
                    let mut plane = DVec4::new(0.0, 0.0, 0.0, 1.0);
                    plane[axis] = sign;
                    body.clip(plane);
                }
            }
            most = most.max(body.vertex_count());
        }
        assert_eq!(most, 20);
    }
}
