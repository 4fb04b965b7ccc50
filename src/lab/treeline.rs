//! The `TreeLine` scene: three detailed trees in a row on a floor, 111,000 triangles, made to study how the shadows of
//! leaves and twigs fall (thesis on the Shadow Mapping Remix Approach, results chapter; it names the number of
//! triangles and the planes 1 and 50; the geometry is this project's own).
//!
//! 1 unit = 1 m. The trees stand on the x axis; a rail fence runs behind them, stones, mushrooms and grass around them.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::scene::SceneModel;
use super::shapes::{MeshBuilder, Random, Ring, perpendicular};

/// Triangles of the scene: the thesis' number. What wood, floor and props leave goes into leaves.
const TRIANGLES: usize = 111_000;

/// Half the side of the square floor, m: the shadow of the tallest tree (8.7 m) stays on it down to a sun 24 degrees
/// high.
const FLOOR_HALF: f64 = 20.0;

/// Cells of the floor per side: six to a wave of the bumps, which therefore look round.
const FLOOR_CELLS: u32 = 40;

/// The angle between neighbouring branches around their parent, radians: the golden angle, as in most trees.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Sides of the tubes, trunk to twig: the smallest numbers that look round from the near viewpoints.
const SIDES: [u32; 5] = [14, 8, 6, 4, 3];

/// What distinguishes one tree from the next.
struct Species {
    key: u64,
    root: DVec3,
    /// Length of the trunk along its bends, m.
    trunk: f64,
    /// Radius of the trunk above its flare, m.
    radius: f64,
    limbs: usize,
    /// Where the lowest limb leaves the trunk, as a share of its length.
    crown_start: f64,
    /// Length of the longest limb as a share of the trunk.
    spread: f64,
    /// Angle between trunk and lowest limb, radians; the highest limb has 0.45 of it.
    pitch: f64,
    /// Leaning of the trunk.
    lean: DVec3,
    /// Length of a leaf, m.
    leaf: f64,
}

const SPECIES: [Species; 3] = [
    Species {
        key: 11,
        root: DVec3::new(-8.6, 0.0, 0.4),
        trunk: 5.4,
        radius: 0.21,
        limbs: 11,
        crown_start: 0.27,
        spread: 0.7,
        pitch: 1.3,
        lean: DVec3::new(0.05, 0.0, 0.06),
        leaf: 0.17,
    },
    Species {
        key: 23,
        root: DVec3::new(0.2, 0.0, -0.5),
        trunk: 6.9,
        radius: 0.24,
        limbs: 13,
        crown_start: 0.27,
        spread: 0.52,
        pitch: 1.1,
        lean: DVec3::new(-0.04, 0.0, 0.02),
        leaf: 0.15,
    },
    Species {
        key: 38,
        root: DVec3::new(8.4, 0.0, 0.2),
        trunk: 5.7,
        radius: 0.2,
        limbs: 10,
        crown_start: 0.3,
        spread: 0.64,
        pitch: 1.15,
        lean: DVec3::new(0.14, 0.0, -0.05),
        leaf: 0.16,
    },
];

/// A branch before it becomes a tube. Limb 0 is the trunk.
struct Branch {
    level: usize,
    limb: usize,
    rings: Vec<Ring>,
}

impl Branch {
    fn triangles(&self) -> usize {
        MeshBuilder::tube_triangles(self.rings.len(), SIDES[self.level], true)
    }

    fn bears_leaves(&self) -> bool {
        self.level >= 3
    }

    /// Centre, radius and direction at `share` (0..1) of the branch.
    fn at(&self, share: f64) -> (DVec3, f64, DVec3) {
        let place = share * (self.rings.len() - 1) as f64;
        let i = (place as usize).min(self.rings.len() - 2);
        let (a, b, t) = (self.rings[i], self.rings[i + 1], place - i as f64);
        (a.centre.lerp(b.centre, t), a.radius + (b.radius - a.radius) * t, (b.centre - a.centre).normalize())
    }
}

/// The scene: equal at every call.
#[must_use]
pub fn treeline() -> SceneModel {
    let mut mesh = MeshBuilder::new("treeline");

    // Lay the floor and what stands on it
    let half = DVec2::splat(FLOOR_HALF);
    mesh.terrain(-half, half, [FLOOR_CELLS, FLOOR_CELLS], floor_height);
    mesh.end_object();
    add_stones(&mut mesh);
    add_fence(&mut mesh);
    add_mushrooms(&mut mesh);
    add_grass(&mut mesh);

    // Grow the wood, then share what is left of the triangles (two a leaf) between the twigs
    let trees = SPECIES.each_ref().map(grow);
    let wood: usize = trees.iter().flatten().map(Branch::triangles).sum();
    let leaves = (TRIANGLES - mesh.triangle_count() - wood) / 2;
    let twigs = trees.iter().flatten().filter(|branch| branch.bears_leaves()).count();

    // Mesh limb by limb, its wood and its foliage apart, as an engine would hold them
    let mut twig = 0;
    for (species, branches) in SPECIES.iter().zip(&trees) {
        let mut random = Random::new(species.key + 1000);
        for limb in 0..=species.limbs {
            let of_limb = || branches.iter().filter(move |branch| branch.limb == limb);
            for branch in of_limb() {
                mesh.tube(&branch.rings, SIDES[branch.level], true);
            }
            mesh.end_object();
            for branch in of_limb().filter(|branch| branch.bears_leaves()) {
                let count = leaves * (twig + 1) / twigs - leaves * twig / twigs;
                add_leaves(&mut mesh, branch, count, species.leaf, &mut random);
                twig += 1;
            }
            mesh.end_object();
        }
    }
    mesh.finish()
}

/// Height of the floor, m: two shallow waves of 5 cm each, 6.5 m and 7.4 m long.
fn floor_height(x: f64, z: f64) -> f64 {
    0.05 * ((x * 0.9 + z * 0.35).sin() + (z * 0.8 - x * 0.3 + 1.0).sin())
}

fn on_floor(x: f64, z: f64) -> DVec3 {
    DVec3::new(x, floor_height(x, z), z)
}

/// Grows a tree, branches in the order parent before child.
fn grow(species: &Species) -> Vec<Branch> {
    let mut random = Random::new(species.key);
    let mut branches = vec![trunk(species, &mut random)];
    for limb in 0..species.limbs {
        // Limbs are longest a third up the crown and point up more the higher they sit
        let share = limb as f64 / (species.limbs - 1) as f64;
        let profile = (1.0 - share * 0.55) * (0.75 + 0.25 * (share * 3.0).min(1.0));
        let at = species.crown_start + (0.97 - species.crown_start) * share;
        let shoot = Shoot {
            at,
            turn: limb as f64 * GOLDEN_ANGLE + random.range(-0.3, 0.3),
            pitch: species.pitch * (1.0 - 0.55 * share),
            length: species.trunk * species.spread * profile * random.range(0.9, 1.1),
        };
        let first = branches.len();
        sprout(&mut branches, 0, limb + 1, &shoot, &mut random);
        grow_children(&mut branches, first, &mut random);
    }
    branches
}

/// A branch to be: where on its parent (0..1), turned how far around it, at which angle to it, and how long (m).
struct Shoot {
    at: f64,
    turn: f64,
    pitch: f64,
    length: f64,
}

fn trunk(species: &Species, random: &mut Random) -> Branch {
    const SEGMENTS: usize = 13;
    let mut centre = species.root - DVec3::Y * 0.25;
    let mut direction = (DVec3::Y + species.lean).normalize();
    let mut rings = Vec::new();
    for i in 0..=SEGMENTS {
        // The foot flares; then the trunk tapers to a third
        let share = i as f64 / SEGMENTS as f64;
        let flare = 1.0 + 0.9 * (-share * 14.0).exp();
        rings.push(Ring { centre, radius: species.radius * flare * (1.0 - 0.68 * share) });
        direction = (direction + random.direction() * 0.07 + DVec3::Y * 0.04).normalize();
        centre += direction * ((species.trunk + 0.25) / SEGMENTS as f64);
    }
    Branch { level: 0, limb: 0, rings }
}

/// Adds one branch to the parent `branches[parent]`.
fn sprout(branches: &mut Vec<Branch>, parent: usize, limb: usize, shoot: &Shoot, random: &mut Random) {
    // Segments per level; how much each wanders, and how strongly it turns to the light
    const SEGMENTS: [usize; 5] = [0, 8, 5, 3, 1];
    const WANDER: [f64; 5] = [0.0, 0.16, 0.2, 0.24, 0.2];
    const LIFT: [f64; 5] = [0.0, 0.07, 0.06, 0.03, -0.05];

    // Start on the axis of the parent, so that no gap opens, and lean away from it
    let level = branches[parent].level + 1;
    let (start, parent_radius, along) = branches[parent].at(shoot.at);
    let side = perpendicular(along);
    let outwards = side * shoot.turn.cos() + along.cross(side) * shoot.turn.sin();
    let mut direction = along * shoot.pitch.cos() + outwards * shoot.pitch.sin();

    // Walk along it; its radius follows its length, yet stays below its parent's
    let segments = SEGMENTS[level];
    let thick = (0.012 + 0.019 * shoot.length).min(parent_radius * 0.75);
    let mut centre = start;
    let mut rings = Vec::with_capacity(segments + 1);
    for i in 0..=segments {
        let share = i as f64 / segments as f64;
        rings.push(Ring { centre, radius: thick * (1.0 - 0.8 * share) + 0.002 });
        direction = (direction + random.direction() * WANDER[level] + DVec3::Y * LIFT[level]).normalize();
        centre += direction * (shoot.length / segments as f64);
    }
    branches.push(Branch { level, limb, rings });
}

/// Adds everything that grows on `branches[first]` and on its children.
fn grow_children(branches: &mut Vec<Branch>, first: usize, random: &mut Random) {
    // Per level of the parent: children per metre, least number of them, their length as a share of what is left
    const DENSITY: [f64; 4] = [0.0, 2.2, 3.2, 5.0];
    const LEAST: [usize; 4] = [0, 4, 3, 2];
    const LENGTH: [f64; 4] = [0.0, 0.62, 0.66, 0.75];

    let mut parent = first;
    while parent < branches.len() {
        let Branch { level, limb, ref rings } = branches[parent];
        parent += 1;
        if level >= LENGTH.len() {
            continue;
        }
        let length: f64 = rings.windows(2).map(|pair| pair[0].centre.distance(pair[1].centre)).sum();
        let children = LEAST[level].max((length * DENSITY[level]).round() as usize);
        let turn = random.range(0.0, TAU);
        for child in 0..children {
            let at = 0.28 + 0.7 * (child as f64 + random.range(0.2, 0.8)) / children as f64;
            let shoot = Shoot {
                at,
                turn: turn + child as f64 * GOLDEN_ANGLE,
                pitch: random.range(0.65, 1.05),
                length: (length * LENGTH[level] * (1.15 - 0.75 * at) * random.range(0.8, 1.2)).max(0.2),
            };
            sprout(branches, parent - 1, limb, &shoot, random);
        }
    }
}

/// Adds `count` leaves along a twig: each a blade of two triangles folded along its midrib.
fn add_leaves(mesh: &mut MeshBuilder, twig: &Branch, count: usize, length: f64, random: &mut Random) {
    for leaf in 0..count {
        // Leave the twig sideways, drooping a little
        let share = (0.25 + 0.75 * (leaf as f64 + random.range(0.0, 1.0)) / count as f64).min(1.0);
        let (start, _, along) = twig.at(share);
        let side = perpendicular(along);
        let turn = leaf as f64 * GOLDEN_ANGLE + random.range(0.0, 0.8);
        let outwards = side * turn.cos() + along.cross(side) * turn.sin();
        let rib = (along * 0.6 + outwards + DVec3::NEG_Y * 0.35 + random.direction() * 0.35).normalize();

        // Face the sky more often than not
        let face = DVec3::Y + random.direction() * 0.8;
        let across = rib.cross(face).try_normalize().unwrap_or(side);
        let up = across.cross(rib);

        // Spread the blade: stalk, right, tip, left
        let long = length * random.range(0.7, 1.2);
        let middle = start + rib * (long * 0.45) + up * (long * 0.08);
        let right = mesh.vertex(middle + across * (long * 0.3));
        let left = mesh.vertex(middle - across * (long * 0.3));
        let stalk = mesh.vertex(start);
        let tip = mesh.vertex(start + rib * long - up * (long * 0.05));
        mesh.triangle([stalk, right, tip]);
        mesh.triangle([stalk, tip, left]);
    }
}

fn add_stones(mesh: &mut MeshBuilder) {
    const STONES: usize = 14;
    let mut random = Random::new(5);
    for _ in 0..STONES {
        let at = on_floor(random.range(-13.0, 13.0), random.range(-5.0, 14.0));
        let size = random.range(0.18, 0.6);
        let half = DVec3::new(size * random.range(0.9, 1.5), size * random.range(0.5, 0.9), size);
        let (bump, phase) = (random.direction() * 3.0, random.range(0.0, TAU));
        let axes = DMat3::from_rotation_y(random.range(0.0, TAU));
        let dent = |unit: DVec3| 1.0 + 0.12 * (unit.dot(bump) + phase).sin() + 0.05 * (unit.z * 7.0 + phase).sin();
        mesh.ellipsoid(at + DVec3::Y * (half.y * 0.35), half, &axes, [14, 8], dent);
        mesh.end_object();
    }
}

/// A rail fence along z = -7, a post every 2 m, one panel an object.
fn add_fence(mesh: &mut MeshBuilder) {
    const PANELS: i32 = 16;
    const SPACING: f64 = 2.0;
    let post = |i: i32| {
        let x = f64::from(i - PANELS / 2) * SPACING;
        on_floor(x, -7.0 + 0.4 * (x * 0.25).sin())
    };
    for i in 0..=PANELS {
        let (here, next) = (post(i), post(i + 1));
        let half = DVec3::new(0.07, 0.75, 0.07);
        mesh.cuboid(here + DVec3::Y * 0.45, half, &DMat3::from_rotation_z(0.05 * f64::from(i * 7).sin()));
        for height in [0.35, 0.7, 1.05] {
            if i < PANELS {
                mesh.bar(here + DVec3::Y * height, next + DVec3::Y * (height + 0.03 * f64::from(i).sin()), 0.08);
            }
        }
        mesh.end_object();
    }
}

/// Rings of mushrooms near the trunks: thin stalks under wide caps stand detached from their shadows.
fn add_mushrooms(mesh: &mut MeshBuilder) {
    let mut random = Random::new(61);
    for species in &SPECIES {
        for _ in 0..7 {
            let (angle, away) = (random.range(0.0, PI), random.range(0.8, 2.2));
            let at = on_floor(species.root.x + away * angle.cos(), species.root.z + away * angle.sin());
            let height = random.range(0.1, 0.24);
            let ring = |y: f64, radius: f64| Ring { centre: at + DVec3::Y * (y * height), radius: radius * height };
            mesh.tube(&[ring(-0.2, 0.16), ring(0.9, 0.11)], 8, true);
            let cap: [Ring; 4] = [ring(0.86, 0.1), ring(0.88, 0.55), ring(1.05, 0.42), ring(1.15, 0.2)];
            mesh.tube(&cap, 10, false);
        }
        mesh.end_object();
    }
}

/// Tufts of grass: single bent blades of three triangles, one object per patch.
fn add_grass(mesh: &mut MeshBuilder) {
    const PATCHES: usize = 24;
    const BLADES: usize = 22;
    let mut random = Random::new(77);
    for _ in 0..PATCHES {
        let (x, z) = (random.range(-14.0, 14.0), random.range(-9.0, 16.0));
        for _ in 0..BLADES {
            let foot = on_floor(x + random.range(-0.5, 0.5), z + random.range(-0.5, 0.5));
            let (sin, cos) = random.range(0.0, TAU).sin_cos();
            let (out, across) = (DVec3::new(cos, 0.0, sin), DVec3::new(-sin, 0.0, cos) * random.range(0.01, 0.02));
            let height = random.range(0.15, 0.5);
            let knee = foot + DVec3::Y * (height * 0.65) + out * (height * 0.15);
            let feet = [foot - across, foot + across].map(|corner| mesh.vertex(corner - DVec3::Y * 0.02));
            let knees = [knee - across * 0.7, knee + across * 0.7].map(|corner| mesh.vertex(corner));
            let tip = mesh.vertex(foot + DVec3::Y * height + out * (height * 0.5));
            mesh.triangle([feet[0], feet[1], knees[1]]);
            mesh.triangle([feet[0], knees[1], knees[0]]);
            mesh.triangle([knees[0], knees[1], tip]);
        }
        mesh.end_object();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::shapes::checks::{assert_number_of_triangles, assert_sound_every_time};

    #[test]
    fn has_the_thesis_number_of_triangles() {
        assert_number_of_triangles(treeline, TRIANGLES);
    }

    #[test]
    fn is_sound_and_equal_every_time() {
        assert_sound_every_time(treeline);
    }

    #[test]
    fn fits_between_its_planes() {
        // From the viewpoints 21 m away the far plane at 50 m must hold floor and crowns
        let model = treeline();
        let highest = model.positions.iter().map(|p| p.y).fold(0.0, f64::max);

        assert!((7.0..10.5).contains(&highest), "highest leaf at {highest} m");
        assert!(model.positions.iter().all(|p| p.x.abs() <= FLOOR_HALF && p.z.abs() <= FLOOR_HALF));
    }
}
