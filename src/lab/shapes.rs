//! What the built-in scenes are made of: a mesh under construction, simple solids, and reproducible random numbers.
//!
//! Every solid is closed and runs counter-clockwise seen from outside. Lengths are in the scene's units.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};

use super::scene::SceneModel;

/// Random numbers as a pure function of (key, counter), so that a scene never depends on a clock or a platform.
///
/// The mixing function is `SplitMix64` (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The counter's step: 2^64 / golden ratio, odd.
    const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

    /// The sequence that belongs to `key`.
    #[must_use]
    pub fn new(key: u64) -> Self {
        Self { state: key.wrapping_mul(Self::STEP) }
    }

    /// The sequence that goes on from a counter's `state`.
    #[must_use]
    pub fn from_state(state: u64) -> Self {
        Self { state }
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(Self::STEP);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number in `low..high`, all 53 bits of it random.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// A whole number in `0..count`; 0 when `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        (self.range(0.0, 1.0) * count as f64) as usize
    }

    /// True with the given probability (0..1).
    pub fn chance(&mut self, probability: f64) -> bool {
        self.range(0.0, 1.0) < probability
    }

    /// A unit vector, every direction equally likely.
    pub fn direction(&mut self) -> DVec3 {
        let (y, angle) = (self.range(-1.0, 1.0), self.range(0.0, TAU));
        let across = (1.0 - y * y).max(0.0).sqrt();
        DVec3::new(across * angle.cos(), y, across * angle.sin())
    }
}

/// Some unit vector perpendicular to the unit vector `axis`.
#[must_use]
pub fn perpendicular(axis: DVec3) -> DVec3 {
    axis.any_orthonormal_vector()
}

/// One cross-section of a tube: its centre and its radius (> 0).
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    /// Middle of the cross-section.
    pub centre: DVec3,
    /// Distance of the surface from the centre.
    pub radius: f64,
}

/// A scene under construction: solids go into the current object until [`MeshBuilder::end_object`].
#[derive(Clone, Debug, Default)]
pub struct MeshBuilder {
    model: SceneModel,
}

impl MeshBuilder {
    /// An empty scene.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { model: SceneModel { name: name.to_owned(), ..SceneModel::default() } }
    }

    /// Triangles so far.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.model.triangles.len()
    }

    /// Closes the current object: what was added since the last call is one mesh instance. Nothing added, no object.
    pub fn end_object(&mut self) {
        let start = self.model.objects.last().map_or(0, |last| last.end);
        if start < self.triangle_count() {
            self.model.objects.push(start..self.triangle_count());
        }
    }

    /// The finished scene; closes the current object.
    #[must_use]
    pub fn finish(mut self) -> SceneModel {
        self.end_object();
        self.model
    }

    /// Adds a vertex and tells its index.
    ///
    /// # Panics
    /// At 2^32 vertices.
    pub fn vertex(&mut self, position: DVec3) -> u32 {
        self.model.positions.push(position);
        u32::try_from(self.model.positions.len() - 1).expect("fewer than 2^32 vertices")
    }

    /// Adds a triangle of vertices added before, counter-clockwise seen from its front.
    pub fn triangle(&mut self, corners: [u32; 3]) {
        self.model.triangles.push(corners);
    }

    /// Adds a flat convex polygon (counter-clockwise seen from its front) with vertices of its own.
    pub fn polygon(&mut self, corners: &[DVec3]) {
        let first = self.model.positions.len() as u32;
        self.model.positions.extend_from_slice(corners);
        for i in 1..corners.len() as u32 - 1 {
            self.triangle([first, first + i, first + i + 1]);
        }
    }

    /// Adds a grid of `columns` x `rows` quads in x and z with heights from `height(x, z)`, its front upwards.
    pub fn terrain(&mut self, low: DVec2, high: DVec2, cells: [u32; 2], height: impl Fn(f64, f64) -> f64) {
        let first = self.model.positions.len() as u32;
        let [columns, rows] = cells;
        for row in 0..=rows {
            for column in 0..=columns {
                let share = DVec2::new(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
                let at = low + (high - low) * share;
                self.vertex(DVec3::new(at.x, height(at.x, at.y), at.y));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
                self.triangle([a, c, d]);
                self.triangle([a, d, b]);
            }
        }
    }

    /// Adds a box around `centre`: `half` is half its size along the columns of `axes` (a rotation).
    pub fn cuboid(&mut self, centre: DVec3, half: DVec3, axes: &DMat3) {
        let bottom = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
        let corner = |(x, z): (f64, f64), y: f64| centre + *axes * (DVec3::new(x, y, z) * half);
        let low = bottom.map(|xz| corner(xz, -1.0));
        let high = bottom.map(|xz| corner(xz, 1.0));
        self.loft(&[&low, &high]);
    }

    /// Adds a box with axes along x, y and z.
    pub fn aligned_box(&mut self, low: DVec3, high: DVec3) {
        self.cuboid((low + high) * 0.5, (high - low) * 0.5, &DMat3::IDENTITY);
    }

    /// Adds a box-shaped bar of a square cross-section from `start` to `end`.
    pub fn bar(&mut self, start: DVec3, end: DVec3, thickness: f64) {
        let along = (end - start).normalize();
        let side = perpendicular(along);
        let axes = DMat3::from_cols(side, along, side.cross(along));
        let half = DVec3::new(thickness * 0.5, (end - start).length() * 0.5, thickness * 0.5);
        self.cuboid((start + end) * 0.5, half, &axes);
    }

    /// Adds a closed solid through outlines of equally many corners, each counter-clockwise seen from beyond the last
    /// one (from above, for outlines stacked upwards); ends are capped by fans.
    pub fn loft(&mut self, outlines: &[&[DVec3]]) {
        let first = self.model.positions.len() as u32;
        let sides = outlines[0].len() as u32;
        for outline in outlines {
            self.model.positions.extend_from_slice(outline);
        }
        self.join_rings(first, outlines.len() as u32, sides);
        self.cap(first, sides, true);
        self.cap(first + (outlines.len() as u32 - 1) * sides, sides, false);
    }

    /// Adds a tube through `rings` (at least two, at different places) with `sides` corners each; the start is open
    /// when `open_start` (it sits inside something else), the end closes in a point beyond the last ring.
    pub fn tube(&mut self, rings: &[Ring], sides: u32, open_start: bool) {
        let first = self.model.positions.len() as u32;
        let last = rings.len() - 1;

        // Carry one frame along the path: turning it least keeps the tube from twisting
        let mut side = perpendicular((rings[1].centre - rings[0].centre).normalize());
        for (i, ring) in rings.iter().enumerate() {
            let along = (rings[(i + 1).min(last)].centre - rings[i.max(1) - 1].centre).normalize();
            side = (side - along * side.dot(along)).normalize();
            let across = along.cross(side);
            for corner in 0..sides {
                let (sin, cos) = (TAU * f64::from(corner) / f64::from(sides)).sin_cos();
                self.vertex(ring.centre + (side * cos + across * sin) * ring.radius);
            }
        }

        // Join the rings, then close the ends
        self.join_rings(first, rings.len() as u32, sides);
        if !open_start {
            self.cap(first, sides, true);
        }
        let end = rings[last].centre - rings[last - 1].centre;
        let tip = self.vertex(rings[last].centre + end.normalize() * rings[last].radius);
        let ring = first + last as u32 * sides;
        for corner in 0..sides {
            self.triangle([ring + corner, ring + (corner + 1) % sides, tip]);
        }
    }

    /// Triangles that [`MeshBuilder::tube`] makes.
    #[must_use]
    pub fn tube_triangles(rings: usize, sides: u32, open_start: bool) -> usize {
        let sides = sides as usize;
        (rings - 1) * sides * 2 + sides + if open_start { 0 } else { sides - 2 }
    }

    /// Adds an ellipsoid of `sides` meridians and `bands` (at least 2) bands from pole to pole; `half` are its half
    /// axes along the columns of `axes` (a rotation), `dent(direction)` scales the radius.
    pub fn ellipsoid(
        &mut self,
        centre: DVec3,
        half: DVec3,
        axes: &DMat3,
        [sides, bands]: [u32; 2],
        dent: impl Fn(DVec3) -> f64,
    ) {
        let place = |unit: DVec3| centre + *axes * (unit * half * dent(unit));
        let bottom = self.vertex(place(DVec3::NEG_Y));
        let first = self.model.positions.len() as u32;
        for band in 1..bands {
            let (up, across) = (-(TAU * 0.5 * f64::from(band) / f64::from(bands)).cos(), f64::from(band));
            let across = (TAU * 0.5 * across / f64::from(bands)).sin();
            for corner in 0..sides {
                let (sin, cos) = (TAU * f64::from(corner) / f64::from(sides)).sin_cos();
                self.vertex(place(DVec3::new(across * cos, up, -across * sin)));
            }
        }
        let top = self.vertex(place(DVec3::Y));
        self.join_rings(first, bands - 1, sides);
        let last = first + (bands - 2) * sides;
        for corner in 0..sides {
            let next = (corner + 1) % sides;
            self.triangle([first + next, first + corner, bottom]);
            self.triangle([last + corner, last + next, top]);
        }
    }

    fn join_rings(&mut self, first: u32, rings: u32, sides: u32) {
        for ring in 0..rings - 1 {
            for corner in 0..sides {
                let a = first + ring * sides + corner;
                let b = first + ring * sides + (corner + 1) % sides;
                self.triangle([a, b, b + sides]);
                self.triangle([a, b + sides, a + sides]);
            }
        }
    }

    fn cap(&mut self, first: u32, sides: u32, reversed: bool) {
        for i in 1..sides - 1 {
            let (b, c) = if reversed { (i + 1, i) } else { (i, i + 1) };
            self.triangle([first, first + b, first + c]);
        }
    }
}

/// A regular outline of `sides` corners around `centre` in x and z, counter-clockwise seen from above;
/// `turn` in radians.
#[must_use]
pub fn outline(centre: DVec3, radius: f64, sides: u32, turn: f64) -> Vec<DVec3> {
    let corner = |i: u32| {
        let (sin, cos) = (turn + TAU * f64::from(i) / f64::from(sides)).sin_cos();
        centre + DVec3::new(cos, 0.0, -sin) * radius
    };
    (0..sides).map(corner).collect()
}

/// What the tests of every built-in scene check.
#[cfg(test)]
pub(crate) mod checks {
    use super::SceneModel;

    /// The scene is about as large as the thesis says: 1 % more or fewer triangles.
    pub(crate) fn assert_number_of_triangles(build: fn() -> SceneModel, expected: usize) {
        let count = build().triangles.len();
        assert!(count.abs_diff(expected) <= expected / 100, "{count} triangles, expected {expected} +- 1 %");
    }

    /// The scene is sound, of a number of objects that culling is about, and the same every time.
    pub(crate) fn assert_sound_every_time(build: fn() -> SceneModel) {
        let model = build();
        assert_sound(&model);
        assert!((20..=400).contains(&model.objects.len()), "{} objects", model.objects.len());
        assert_eq!(fingerprint(&model), fingerprint(&build()));
    }

    /// A hash of everything that is drawn.
    fn fingerprint(model: &SceneModel) -> blake3::Hash {
        let mut hasher = blake3::Hasher::new();
        for position in &model.positions {
            hasher.update(bytemuck::bytes_of(&position.to_array()));
        }
        hasher.update(bytemuck::cast_slice(&model.triangles));
        hasher.finalize()
    }

    /// Finite positions, indices in range, triangles with area (in `f32` too), objects that cover all in order.
    fn assert_sound(model: &SceneModel) {
        assert!(model.positions.iter().all(|position| position.is_finite()));
        for (id, triangle) in model.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|vertex| model.positions[vertex as usize].as_vec3().as_dvec3());
            assert!((b - a).cross(c - a).length() > 0.0, "triangle {id} has no area: {a} {b} {c}");
        }
        let mut end = 0;
        for object in &model.objects {
            assert!(object.start == end && object.end > object.start, "object {object:?} after {end}");
            end = object.end;
        }
        assert_eq!(end, model.triangles.len(), "the objects cover all triangles");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the signed volume: positive for closed meshes that run counter-clockwise seen from outside.
    fn signed_volume(model: &SceneModel) -> f64 {
        let corner = |index: u32| model.positions[index as usize];
        model.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum::<f64>() / 6.0
    }

    /// Every edge is used once in each direction.
    fn is_closed(model: &SceneModel) -> bool {
        let mut edges = std::collections::BTreeMap::new();
        for [a, b, c] in &model.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
            }
        }
        edges.values().all(|&balance| balance == 0)
    }

    fn built(add: impl Fn(&mut MeshBuilder)) -> SceneModel {
        let mut builder = MeshBuilder::new("solid");
        add(&mut builder);
        builder.finish()
    }

    #[test]
    fn solids_are_closed_and_face_outwards() {
        let turned = DMat3::from_rotation_y(0.7);
        let at = DVec3::new(3.0, -2.0, 5.0);
        let rings = [(0.0, 1.0), (2.0, 0.8), (3.0, 0.2)].map(|(y, radius)| Ring { centre: at + DVec3::Y * y, radius });
        let solids = [
            ("cuboid", built(|b| b.cuboid(at, DVec3::new(1.0, 2.0, 3.0), &turned)), 48.0, 1e-9),
            ("bar", built(|b| b.bar(at, at + DVec3::new(3.0, 4.0, 0.0), 0.5)), 1.25, 1e-9),
            ("prism", built(|b| b.loft(&[&outline(at, 1.0, 4, 0.3), &outline(at + DVec3::Y, 1.0, 4, 0.3)])), 2.0, 1e-9),
            ("sphere", built(|b| b.ellipsoid(at, DVec3::ONE, &turned, [64, 32], |_| 1.0)), 4.0 / 3.0 * TAU / 2.0, 0.02),
            ("tube", built(|b| b.tube(&rings, 96, false)), 0.5 * TAU * (1.6267 + 0.28 + 0.0027), 0.02),
        ];
        for (name, model, volume, tolerance) in solids {
            assert!(is_closed(&model), "{name} is not closed");
            let measured = signed_volume(&model);
            assert!((measured - volume).abs() < tolerance, "{name}: volume {measured}, expected {volume}");
        }
    }

    #[test]
    fn tube_triangles_are_counted() {
        let rings = [Ring { centre: DVec3::ZERO, radius: 1.0 }, Ring { centre: DVec3::Y, radius: 0.5 }];
        for open in [false, true] {
            let model = built(|b| b.tube(&rings, 7, open));
            assert_eq!(model.triangles.len(), MeshBuilder::tube_triangles(2, 7, open));
        }
    }

    #[test]
    fn terrain_faces_up() {
        let model = built(|b| b.terrain(DVec2::ZERO, DVec2::ONE, [3, 2], |x, z| x * z));
        for [a, b, c] in &model.triangles {
            let [a, b, c] = [a, b, c].map(|i| model.positions[*i as usize]);
            assert!((b - a).cross(c - a).y > 0.0);
        }
        assert_eq!(model.triangles.len(), 12);
    }

    #[test]
    fn random_numbers_fill_their_range() {
        let mut random = Random::new(7);
        let numbers: Vec<f64> = (0..10_000).map(|_| random.range(2.0, 4.0)).collect();
        let mean = numbers.iter().sum::<f64>() / 10_000.0;
        assert!(numbers.iter().all(|n| (2.0..4.0).contains(n)) && (mean - 3.0).abs() < 0.02, "mean {mean}");
        assert_eq!(Random::new(7).bits(), Random::new(7).bits());
        assert_ne!(Random::new(7).bits(), Random::new(8).bits());
    }
}
