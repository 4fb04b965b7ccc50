//! The `SparseCity` scene: 33,000 triangles over 8 km^2, mostly plain buildings, and one small detailed figure; made to
//! study how techniques behave where the shadow map must stretch over kilometres (thesis on the Shadow Mapping Remix
//! Approach, results chapter; it names the number of triangles and the planes 15 and 5000; the geometry is this
//! project's own).
//!
//! 1 unit = 1 m. Blocks of 170 m around the origin hold two to five buildings or nothing; the figure, a robot 6 m tall,
//! stands on the plaza at [`FIGURE`].

use glam::{DMat3, DVec2, DVec3};

use super::scene::SceneModel;
use super::shapes::{MeshBuilder, Random, Ring, outline};

/// Where the figure stands, m: between its feet, on the plaza.
pub const FIGURE: DVec3 = DVec3::new(8.0, PAVEMENT, 4.0);

/// Height of the figure's head, m above [`FIGURE`].
pub const FIGURE_HEIGHT: f64 = 6.0;

/// Triangles of the scene: the thesis' number. Blocks are filled until it is reached.
const TRIANGLES: usize = 33_000;

/// Triangles below which no further block is begun. 0 would overshoot by a building; thousands would miss the number.
const LEAST_BLOCK: usize = 60;

/// Triangles a park may take (8 trees of 53 at most).
const PARK: usize = 430;

/// Half the side of the square ground, m: 2.83 km squared make the thesis' 8 km^2.
const GROUND_HALF: f64 = 1_414.0;

/// From one street axis to the next, m.
const BLOCK: f64 = 170.0;

/// Blocks on each side of the middle one; the outermost end inside the ground.
const BLOCKS: i32 = 7;

/// Half the side of a block's pavement, m: what remains are streets 30 m wide.
const PAVEMENT_HALF: f64 = 70.0;

/// Height of the pavement above the street, m.
const PAVEMENT: f64 = 0.3;

/// The scene: equal at every call.
#[must_use]
pub fn sparse_city() -> SceneModel {
    let mut mesh = MeshBuilder::new("sparse-city");
    let mut random = Random::new(1_409);

    // Lay the ground and the plaza in the middle
    mesh.terrain(DVec2::splat(-GROUND_HALF), DVec2::splat(GROUND_HALF), [16, 16], |_, _| 0.0);
    mesh.end_object();
    add_pavement(&mut mesh, DVec2::ZERO);
    mesh.end_object();
    add_plaza(&mut mesh);
    add_figure(&mut mesh);
    add_avenue(&mut mesh, &mut random);

    // Fill blocks in a random order, near ones rather earlier, until the triangles are used up: the rest stays empty
    let mut blocks = Vec::new();
    for (x, z) in (-BLOCKS..=BLOCKS).flat_map(|x| (-BLOCKS..=BLOCKS).map(move |z| (x, z))) {
        let away = f64::from(x).hypot(f64::from(z)) / f64::from(BLOCKS);
        if away > 0.0 {
            blocks.push((random.range(0.0, 1.0) + 0.6 * away, away, DVec2::new(f64::from(x), f64::from(z)) * BLOCK));
        }
    }
    blocks.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, away, centre) in blocks {
        if mesh.triangle_count() + LEAST_BLOCK < TRIANGLES {
            add_block(&mut mesh, centre, away, &mut random);
        }
    }
    mesh.finish()
}

fn add_pavement(mesh: &mut MeshBuilder, centre: DVec2) {
    let half = DVec3::new(PAVEMENT_HALF, 0.25 + PAVEMENT * 0.5, PAVEMENT_HALF);
    mesh.cuboid(DVec3::new(centre.x, PAVEMENT - half.y, centre.y), half, &DMat3::IDENTITY);
}

/// A block: its pavement, two to five buildings on quarters of it, or a park.
fn add_block(mesh: &mut MeshBuilder, centre: DVec2, away: f64, random: &mut Random) {
    add_pavement(mesh, centre);
    mesh.end_object();
    if random.chance(0.12) && mesh.triangle_count() + PARK < TRIANGLES {
        add_park(mesh, centre, random);
        return;
    }
    for quarter in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        if random.chance(0.22) || mesh.triangle_count() + LEAST_BLOCK > TRIANGLES {
            continue;
        }
        // Place it well inside its quarter: sizes below 27 m keep 3 m of pavement
        let lot = Lot {
            centre: DVec3::new(centre.x + quarter.0 * 35.0, PAVEMENT, centre.y + quarter.1 * 35.0),
            half: DVec2::new(random.range(13.0, 27.0), random.range(13.0, 27.0)),
            turn: if random.chance(0.2) { random.range(-0.2, 0.2) } else { 0.0 },
        };
        let tall = (1.0 - away).max(0.0);
        match random.below(6) {
            0 => add_house(mesh, &lot, random),
            1 => add_courtyard(mesh, &lot, random),
            2 => add_cylinder(mesh, &lot, 20.0 + 70.0 * tall * random.range(0.4, 1.0)),
            3 if away < 0.6 => add_tower(mesh, &lot, 60.0 + 130.0 * tall * random.range(0.3, 1.0), random),
            _ => add_slab(mesh, &lot, random.range(10.0, 22.0) + 40.0 * tall * random.range(0.0, 1.0), random),
        }
        mesh.end_object();
    }
}

/// A building's ground: everything stands in its frame (x and z along its sides, y up).
struct Lot {
    centre: DVec3,
    half: DVec2,
    turn: f64,
}

impl Lot {
    fn axes(&self) -> DMat3 {
        DMat3::from_rotation_y(self.turn)
    }

    fn place(&self, x: f64, y: f64, z: f64) -> DVec3 {
        self.centre + self.axes() * DVec3::new(x, y, z)
    }

    /// A box over x, z in `centre -+ half`, from height `low` to `high`.
    fn storey(&self, mesh: &mut MeshBuilder, centre: DVec2, half: DVec2, low: f64, high: f64) {
        let middle = self.place(centre.x, (low + high) * 0.5, centre.y);
        mesh.cuboid(middle, DVec3::new(half.x, (high - low) * 0.5, half.y), &self.axes());
    }
}

/// A flat-roofed block with window ledges around every third floor, a parapet's rim and machines on the roof.
fn add_slab(mesh: &mut MeshBuilder, lot: &Lot, height: f64, random: &mut Random) {
    lot.storey(mesh, DVec2::ZERO, lot.half, -0.2, height);
    let ledges = ((height / 9.0) as u32).min(4);
    for ledge in 1..=ledges {
        let at = height * f64::from(ledge) / f64::from(ledges + 1);
        lot.storey(mesh, DVec2::ZERO, lot.half + 0.8, at, at + 0.7);
    }
    lot.storey(mesh, DVec2::ZERO, lot.half + 0.4, height, height + 0.9);
    for _ in 0..random.below(3) {
        let at = lot.half * DVec2::new(random.range(-0.7, 0.7), random.range(-0.7, 0.7));
        let half = DVec2::new(random.range(1.5, 4.0), random.range(1.5, 4.0));
        lot.storey(mesh, at, half, height + 0.9, height + random.range(2.5, 5.0));
    }
}

/// A tower that steps back twice or thrice, with fins down its front and a mast.
fn add_tower(mesh: &mut MeshBuilder, lot: &Lot, height: f64, random: &mut Random) {
    const STEPS: u32 = 3;
    let (mut half, mut low) = (lot.half * 0.9, -0.2);
    for step in 1..=STEPS {
        let high = height * (f64::from(step) / f64::from(STEPS)).powf(0.7);
        lot.storey(mesh, DVec2::ZERO, half, low, high);
        lot.storey(mesh, DVec2::ZERO, half + 0.7, high - 2.0, high - 1.0);
        for side in [-1.0, 1.0] {
            for fin in [-0.45, 0.45] {
                let at = DVec2::new(half.x * fin, side * (half.y + 0.6));
                lot.storey(mesh, at, DVec2::new(0.5, 0.7), low.max(0.0), high + 1.5);
            }
        }
        half *= random.range(0.62, 0.8);
        low = high;
    }
    let foot = lot.place(0.0, height, 0.0);
    let mast = [(0.0, 0.9), (height * 0.12, 0.6), (height * 0.22, 0.15)];
    mesh.tube(&mast.map(|(y, radius)| Ring { centre: foot + DVec3::Y * y, radius }), 6, true);
}

/// A house under a gabled roof with eaves and a chimney.
fn add_house(mesh: &mut MeshBuilder, lot: &Lot, random: &mut Random) {
    let (half, eaves) = (lot.half * 0.75, random.range(6.0, 11.0));
    let ridge = eaves + half.y * random.range(0.5, 0.8);
    lot.storey(mesh, DVec2::ZERO, half, -0.2, eaves);
    let gable = |x: f64| [(half.y + 1.2, eaves), (-half.y - 1.2, eaves), (0.0, ridge)].map(|(z, y)| lot.place(x, y, z));
    mesh.loft(&[&gable(-half.x - 1.0), &gable(half.x + 1.0)]);
    let at = DVec2::new(half.x * 0.5, half.y * 0.4);
    lot.storey(mesh, at, DVec2::splat(0.9), eaves, ridge + 1.8);
    lot.storey(mesh, DVec2::new(0.0, half.y + 1.4), DVec2::new(2.4, 1.4), -0.2, 3.4);
}

/// Four wings around a yard, one of them on columns: light enters below.
fn add_courtyard(mesh: &mut MeshBuilder, lot: &Lot, random: &mut Random) {
    let (half, height) = (lot.half.max(DVec2::splat(18.0)), random.range(12.0, 24.0));
    let wing = half * 0.3;
    lot.storey(mesh, DVec2::new(0.0, wing.y - half.y), DVec2::new(half.x, wing.y), -0.2, height);
    for side in [-1.0, 1.0] {
        let at = DVec2::new(side * (half.x - wing.x), wing.y * 0.5);
        lot.storey(mesh, at, DVec2::new(wing.x, half.y - wing.y * 1.5), -0.2, height * 0.8);
    }
    lot.storey(mesh, DVec2::new(0.0, half.y - wing.y * 0.5), DVec2::new(half.x, wing.y * 0.5), 6.0, height * 0.7);
    for column in 0..6 {
        let x = half.x * (f64::from(column) / 2.5 - 1.0) * 0.9;
        lot.storey(mesh, DVec2::new(x, half.y - 0.8), DVec2::splat(0.6), -0.2, 6.0);
    }
}

/// A round building with a collar and a low cone on top: a gasometer, a silo.
fn add_cylinder(mesh: &mut MeshBuilder, lot: &Lot, height: f64) {
    let radius = lot.half.min_element() * 0.8;
    let at = |y: f64, share: f64| outline(lot.place(0.0, y, 0.0), radius * share, 14, lot.turn);
    let rings = [at(-0.2, 1.0), at(height * 0.8, 1.0), at(height * 0.8, 1.12), at(height * 0.85, 1.12)];
    let top = [at(height * 0.85, 0.96), at(height, 0.96), at(height + radius * 0.35, 0.1)];
    let all: Vec<&[DVec3]> = rings.iter().chain(&top).map(Vec::as_slice).collect();
    mesh.loft(&all);
}

/// A park of a few trees.
fn add_park(mesh: &mut MeshBuilder, centre: DVec2, random: &mut Random) {
    for _ in 0..8 {
        let at = centre + DVec2::new(random.range(-60.0, 60.0), random.range(-60.0, 60.0));
        add_tree(mesh, at, random.range(5.0, 9.0), random.chance(0.5));
    }
    mesh.end_object();
}

/// Trees along both sides of the street at x = 85 m, one object per block.
fn add_avenue(mesh: &mut MeshBuilder, random: &mut Random) {
    const SPACING: f64 = 20.0;
    for block in -2..=2 {
        for x in [67.5, 102.5] {
            for i in -3..=3 {
                let z = f64::from(block) * BLOCK + f64::from(i) * SPACING;
                let at = DVec2::new(x + random.range(-0.5, 0.5), z);
                add_tree(mesh, at, random.range(4.5, 6.5), false);
            }
            mesh.end_object();
        }
    }
}

/// A low-polygon tree, conical or round; its height is 1.5 sizes.
fn add_tree(mesh: &mut MeshBuilder, at: DVec2, size: f64, conical: bool) {
    let foot = DVec3::new(at.x, PAVEMENT, at.y);
    let ring = |y: f64, radius: f64| Ring { centre: foot + DVec3::Y * (y * size), radius: radius * size };
    mesh.tube(&[ring(-0.1, 0.06), ring(0.6, 0.05)], 4, true);
    if conical {
        mesh.tube(&[ring(0.35, 0.38), ring(0.8, 0.24), ring(1.35, 0.05)], 7, false);
    } else {
        let half = DVec3::new(0.42, 0.5, 0.42) * size;
        mesh.ellipsoid(foot + DVec3::Y * size, half, &DMat3::IDENTITY, [6, 4], |_| 1.0);
    }
}

/// Lamps, bollards, benches and a colonnade around the figure: fine shadows beside coarse ones.
fn add_plaza(mesh: &mut MeshBuilder) {
    // Lamps in two rows, arms over the middle
    for i in 0..6 {
        let along = -50.0 + 20.0 * f64::from(i);
        for side in [-1.0, 1.0] {
            let foot = DVec3::new(along, PAVEMENT, side * 16.0);
            let ring = |y: f64, radius: f64| Ring { centre: foot + DVec3::Y * y, radius };
            mesh.tube(&[ring(-0.1, 0.22), ring(4.0, 0.14), ring(9.0, 0.1)], 6, true);
            let arm = foot + DVec3::new(0.0, 8.9, 0.0);
            mesh.bar(arm, arm + DVec3::new(0.0, 0.5, -side * 2.6), 0.14);
            let head = arm + DVec3::new(0.0, 0.35, -side * 2.9);
            mesh.cuboid(head, DVec3::new(0.35, 0.14, 0.7), &DMat3::IDENTITY);
            mesh.end_object();
        }
    }

    // Bollards with a chain's rail between them
    for i in 0..14 {
        let foot = DVec3::new(-12.0 + 3.0 * f64::from(i), PAVEMENT, -6.0);
        mesh.aligned_box(foot - DVec3::new(0.16, 0.1, 0.16), foot + DVec3::new(0.16, 1.3, 0.16));
        mesh.bar(foot + DVec3::Y * 1.0, foot + DVec3::new(3.0, 1.0, 0.0), 0.08);
    }
    mesh.end_object();

    // Benches of slats
    for bench in 0..4 {
        let at = DVec3::new(-8.0 + 9.0 * f64::from(bench), PAVEMENT, 11.0);
        for slat in 0..4 {
            let z = 0.28 * f64::from(slat);
            mesh.aligned_box(at + DVec3::new(-1.6, 0.62, z), at + DVec3::new(1.6, 0.7, z + 0.18));
        }
        for x in [-1.3, 1.3] {
            mesh.aligned_box(at + DVec3::new(x - 0.1, -0.1, 0.1), at + DVec3::new(x + 0.1, 0.62, 0.95));
        }
        mesh.end_object();
    }

    // A colonnade behind the figure
    for column in 0..9 {
        let foot = DVec3::new(-24.0 + 6.0 * f64::from(column), PAVEMENT, -28.0);
        let ring = |y: f64, radius: f64| outline(foot + DVec3::Y * y, radius, 12, 0.0);
        mesh.loft(&[&ring(-0.1, 0.9), &ring(0.6, 0.75), &ring(9.4, 0.6), &ring(10.0, 0.95)]);
    }
    mesh.aligned_box(DVec3::new(-25.6, PAVEMENT + 10.0, -29.6), DVec3::new(25.6, PAVEMENT + 11.8, -26.4));
    mesh.end_object();
}

/// The robot: limbs of tubes and joints of spheres, one arm raised, fingers spread, aerial on its head.
fn add_figure(mesh: &mut MeshBuilder) {
    let mut part = FigurePart { mesh, axes: DMat3::from_rotation_y(-0.6) };

    // Legs with feet and toes
    for side in [-1.0, 1.0] {
        let (hip, knee) = (DVec3::new(side * 0.5, 2.9, 0.0), DVec3::new(side * 0.62, 1.6, 0.14));
        let ankle = DVec3::new(side * 0.66, 0.35, -0.05);
        part.limb(hip, knee, 0.3, 0.23);
        part.limb(knee, ankle, 0.24, 0.17);
        part.joint(knee, 0.29);
        part.slab(DVec3::new(side * 0.68, 0.13, 0.2), DVec3::new(0.26, 0.13, 0.5));
        for toe in [-0.16, 0.0, 0.16] {
            let root = DVec3::new(side * 0.68 + toe, 0.1, 0.68);
            part.limb(root, root + DVec3::new(toe * 0.3, -0.02, 0.24), 0.08, 0.06);
        }
    }

    // Pelvis, trunk, pack and head
    part.slab(DVec3::new(0.0, 2.95, 0.0), DVec3::new(0.72, 0.24, 0.36));
    part.blob(DVec3::new(0.0, 3.9, 0.0), DVec3::new(0.82, 0.85, 0.5));
    part.slab(DVec3::new(0.0, 4.0, -0.66), DVec3::new(0.5, 0.55, 0.2));
    part.limb(DVec3::new(0.0, 4.6, 0.0), DVec3::new(0.0, 4.95, 0.02), 0.2, 0.18);
    part.blob(DVec3::new(0.0, 5.35, 0.05), DVec3::new(0.42, 0.48, 0.44));
    for side in [-1.0, 1.0] {
        part.joint(DVec3::new(side * 0.17, 5.42, 0.44), 0.1);
        part.joint(DVec3::new(side * 0.44, 5.35, 0.03), 0.13);
    }
    part.limb(DVec3::new(0.15, 5.7, -0.05), DVec3::new(0.3, FIGURE_HEIGHT - 0.05, -0.12), 0.03, 0.02);
    part.joint(DVec3::new(0.3, FIGURE_HEIGHT - 0.07, -0.12), 0.07);

    // One arm waves, the other hangs
    part.arm([DVec3::new(0.85, 4.4, 0.0), DVec3::new(1.75, 4.55, 0.15), DVec3::new(2.1, 5.5, 0.4)]);
    part.arm([DVec3::new(-0.85, 4.4, 0.0), DVec3::new(-1.25, 3.35, 0.1), DVec3::new(-1.2, 2.45, 0.55)]);
    part.mesh.end_object();
}

/// Parts of the figure, in its own frame: x to its left, z the way it looks, y up, origin at [`FIGURE`].
struct FigurePart<'a> {
    mesh: &'a mut MeshBuilder,
    axes: DMat3,
}

impl FigurePart<'_> {
    fn place(&self, at: DVec3) -> DVec3 {
        FIGURE + self.axes * at
    }

    fn limb(&mut self, start: DVec3, end: DVec3, thick: f64, thin: f64) {
        let bulge = [(0.0, 0.75), (0.12, 1.0), (0.35, 1.06), (0.7, 0.9), (0.9, 0.85), (1.0, 0.7)];
        let ring = |(share, swell): (f64, f64)| Ring {
            centre: self.place(start.lerp(end, share)),
            radius: (thick + (thin - thick) * share) * swell,
        };
        self.mesh.tube(&bulge.map(ring), 10, false);
    }

    fn joint(&mut self, at: DVec3, radius: f64) {
        let centre = self.place(at);
        self.mesh.ellipsoid(centre, DVec3::splat(radius), &self.axes, [10, 6], |_| 1.0);
    }

    fn blob(&mut self, at: DVec3, half: DVec3) {
        let centre = self.place(at);
        // Flatten the sides a little: armour rather than a ball
        let dent = |unit: DVec3| 1.0 / unit.abs().powf(4.0).element_sum().powf(0.25).max(0.72);
        self.mesh.ellipsoid(centre, half, &self.axes, [20, 12], dent);
    }

    fn slab(&mut self, at: DVec3, half: DVec3) {
        let centre = self.place(at);
        self.mesh.cuboid(centre, half, &self.axes);
    }

    /// Upper arm, forearm, palm and five fingers.
    fn arm(&mut self, [shoulder, elbow, wrist]: [DVec3; 3]) {
        self.joint(shoulder, 0.34);
        self.limb(shoulder, elbow, 0.23, 0.18);
        self.joint(elbow, 0.22);
        self.limb(elbow, wrist, 0.2, 0.13);
        self.joint(wrist, 0.16);
        let along = (wrist - elbow).normalize();
        let across = along.cross(DVec3::Z).normalize();
        for finger in 0..5 {
            let angle = (f64::from(finger) - 2.0) * 0.36;
            let out = along * angle.cos() + across * angle.sin();
            let knuckle = wrist + out * 0.18;
            self.limb(knuckle, knuckle + out * 0.32 + DVec3::Z * 0.06, 0.055, 0.035);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::shapes::checks::{assert_number_of_triangles, assert_sound_every_time};

    #[test]
    fn has_the_thesis_number_of_triangles() {
        assert_number_of_triangles(sparse_city, TRIANGLES);
    }

    #[test]
    fn is_sound_and_equal_every_time() {
        assert_sound_every_time(sparse_city);
    }

    #[test]
    fn solids_face_outwards() {
        // Seen from its own first corner, a closed object that faces outwards has a positive volume
        let model = sparse_city();
        for object in model.objects.iter().skip(1) {
            let from = model.positions[model.triangles[object.start][0] as usize];
            let volume: f64 = model.triangles[object.clone()]
                .iter()
                .map(|corners| corners.map(|vertex| model.positions[vertex as usize] - from))
                .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
                .sum();
            assert!(volume > 0.3, "object {object:?}: {volume} m^3");
        }
    }

    #[test]
    fn covers_eight_square_kilometres() {
        let model = sparse_city();
        let low = model.positions.iter().copied().reduce(DVec3::min).unwrap();
        let high = model.positions.iter().copied().reduce(DVec3::max).unwrap();
        let area = (high.x - low.x) * (high.z - low.z);
        assert!((area - 8e6).abs() < 1e5, "{area} m^2");
    }

    #[test]
    fn buildings_reach_the_outer_blocks() {
        // The budget must not run out near the middle: kilometres of city are the point of the scene
        let model = sparse_city();
        let reach = |object: &std::ops::Range<usize>| {
            let corner = model.positions[model.triangles[object.start][0] as usize];
            corner.x.abs().max(corner.z.abs())
        };
        let far = model.objects.iter().skip(1).filter(|object| reach(object) > 900.0).count();
        assert!(far > 40, "{far} objects beyond 900 m");
    }
}
