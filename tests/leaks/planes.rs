//! Slanted planes under wide blurs: how much of a plane shades itself.

use antumbra::lab::scene::SceneModel;
use antumbra::{
    Aabb, Camera, Encoding, FitInput, Light, MapBudget, MomentFormat, MomentKind, Moments, Prefilter, Radius, Remix,
    Scene, ShadowTechnique, techniques,
};
use glam::{DVec2, DVec3, UVec2, Vec3};
use rayon::prelude::*;

use crate::drawn::Drawn;
use crate::encodings::formats;

/// Half the side of the cube that the plane lies in, world units: the depth range and the width of the map.
const HALF: f64 = 5.0;

/// Side of the map, texels. At 85° and a radius of 16 texels more than half of the depth range is averaged.
const SIDE: u32 = 256;

/// Half-widths of blurs, texels.
const RADII: [f32; 5] = [0.5, 1.5, 4.0, 8.0, 16.0];

/// Angles between plane and map, degrees.
const SLOPES: [f64; 8] = [0.0, 1.0, 5.0, 30.0, 60.0, 75.0, 80.0, 85.0];

/// Directions in which planes fall, degrees from a side of the map.
const AZIMUTHS: [f64; 2] = [0.0, 45.0];

/// Points of a plane that are looked up, along each axis of the map.
const POINTS: u32 = 61;

/// A plane through the middle of the cube.
struct Plane {
    model: SceneModel,
    normal: DVec3,
}

impl Plane {
    fn new(slope: f64, azimuth: f64) -> Self {
        let (sin, cos) = slope.to_radians().sin_cos();
        let (z, x) = azimuth.to_radians().sin_cos();
        let normal = DVec3::new(sin * x, cos, sin * z);
        let across = normal.any_orthonormal_vector();
        let along = normal.cross(across);
        let corner = |a: f64, b: f64| (across * a + along * b) * 8.0 * HALF;
        let model = SceneModel {
            positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            objects: core::iter::once(0..2).collect(),
            ..SceneModel::default()
        };
        Self { model, normal }
    }

    /// The point of the plane below a point of the map's plane.
    fn at(&self, place: DVec2) -> DVec3 {
        let height = -(self.normal.x * place.x + self.normal.z * place.y) / self.normal.y;
        DVec3::new(place.x, height, place.y)
    }

    fn input() -> FitInput<'static> {
        let bounds = Aabb::new(DVec3::splat(-HALF), DVec3::splat(HALF));
        let eye = DVec3::new(1.0, 12.0, 18.0);
        FitInput {
            camera: Camera::perspective(Camera::look_at(eye, DVec3::ZERO, DVec3::Y), 0.9, 1.0, 1.0, 100.0),
            light: Light::Directional { travel: DVec3::NEG_Y },
            scene: Scene::within(bounds),
            map: MapBudget::one(SIDE),
            origin: DVec3::ZERO,
            previous: None,
        }
    }
}

/// Most shadow that a plane may throw on itself, mean share of the light.
const MOST: f64 = 1e-3;

/// A plane, drawn and filtered, and points of it.
struct Filtered {
    drawn: Drawn,
    normal: Vec3,
    points: Vec<Vec3>,
    /// What the bias adds to a reach without the blur, texels.
    unlifted: f32,
}

impl Filtered {
    /// Points are those whose blur stays on what is drawn of the plane: it leaves the cube where it is steep.
    fn new(plane: &Plane, moments: Moments, radius: f32, widening: f64) -> Self {
        let remix = |moments| {
            let prefilter = Prefilter { radius: Radius::Texels(radius), ..Prefilter::of(moments) };
            Remix { encoding: Encoding::Moments(prefilter), ..techniques::ssm() }
        };
        let drawn = Drawn::new(&plane.model, &Plane::input(), &remix(moments));
        let two = Moments::new(MomentKind::Variance, moments.format());
        let unlifted = remix(two).fit(&Plane::input()).expect("a legal input").uniforms.views[0].bias[0];
        let texel = 2.0 * HALF / f64::from(SIDE);
        let reach = (f64::from(radius) + 2.0 + widening) * texel;
        let steepest = DVec2::new(plane.normal.x, plane.normal.z) / plane.normal.y;
        let room = HALF - reach * (steepest.x.abs() + steepest.y.abs());
        let place = |index: u32| (f64::from(index) / f64::from(POINTS - 1) * 2.0 - 1.0) * (HALF - 2.0 * reach);
        let places = (0..POINTS * POINTS).map(|index| DVec2::new(place(index % POINTS), place(index / POINTS)));
        let on_plane = places.map(|place| plane.at(place)).filter(|point| point.y.abs() <= room);
        Self { drawn, normal: plane.normal.as_vec3(), points: on_plane.map(DVec3::as_vec3).collect(), unlifted }
    }

    /// Mean shadow where there is none.
    fn shadow(&self) -> f64 {
        let shadow = |point: &Vec3| 1.0 - f64::from(self.drawn.lit(*point, self.normal));
        self.points.iter().map(shadow).sum::<f64>() / self.points.len() as f64
    }

    /// The same with receivers lifted by another number of texels.
    fn shadow_lifted(&mut self, texels: f32) -> f64 {
        self.drawn.frame.uniforms.views[0].bias[0] = self.unlifted + texels;
        self.shadow()
    }

    /// Least lift that leaves no more shadow than may be, as a share of the radius; up to 2.
    fn needed(&mut self, radius: f32) -> f64 {
        let (mut low, mut high) = (0.0, 2.0);
        if self.shadow_lifted(0.0) <= MOST {
            return 0.0;
        }
        for _ in 0..10 {
            let middle = 0.5 * (low + high);
            if self.shadow_lifted(middle * radius) <= MOST { high = middle } else { low = middle }
        }
        f64::from(high)
    }
}

/// What one slope and radius need.
#[derive(Clone, Copy)]
struct Cell {
    /// Shadow as receivers are lifted, and not lifted for the blur.
    shadow: f64,
    unlifted: f64,
    /// Share of the radius that is needed.
    needed: f64,
    points: usize,
}

fn cell(moments: Moments, slope: f64, radius: f32) -> Cell {
    let of = |azimuth| {
        let mut filtered = Filtered::new(&Plane::new(slope, azimuth), moments, radius, 0.0);
        let shadow = filtered.shadow();
        let unlifted = filtered.shadow_lifted(0.0);
        Cell { shadow, unlifted, needed: filtered.needed(radius), points: filtered.points.len() }
    };
    let [along, across] = AZIMUTHS.map(of);
    Cell {
        shadow: along.shadow.max(across.shadow),
        unlifted: along.unlifted.max(across.unlifted),
        needed: along.needed.max(across.needed),
        points: along.points.min(across.points),
    }
}

#[test]
fn planes_under_wide_blurs_do_not_shade_themselves() {
    println!(
        "Shadow on planes that have none, % of the light: as lifted / not lifted for the blur / needed lift, share of the radius."
    );
    let mut broken = Vec::new();
    for (name, kind, format) in formats() {
        println!("\n| {name} | {} |", RADII.map(|radius| format!("radius {radius}")).join(" | "));
        for slope in SLOPES {
            let moments = Moments::new(kind, format);
            let cells: Vec<Cell> = RADII.par_iter().map(|radius| cell(moments, slope, *radius)).collect();
            let say = |cell: &Cell| {
                if cell.points == 0 {
                    return "-".to_owned();
                }
                format!("{:.3} / {:.3} / {:.3}", 100.0 * cell.shadow, 100.0 * cell.unlifted, cell.needed)
            };
            println!("| {slope} | {} |", cells.iter().map(say).collect::<Vec<_>>().join(" | "));
            for (cell, radius) in cells.iter().zip(RADII) {
                if cell.points > 0 && !(cell.shadow <= MOST) {
                    broken.push(format!("{name}, {slope}°, radius {radius}: {}", cell.shadow));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Levels of the mip chain, some of them between two.
const LEVELS: [f32; 6] = [0.0, 1.0, 1.4, 2.0, 2.4, 3.0];

/// Levels of the mip chain are wider than a texel as well.
#[test]
fn planes_in_small_levels_do_not_shade_themselves() {
    println!("Shadow on planes that have none, % of the light, radius 1.5, by level of the mip chain.");
    let mut broken = Vec::new();
    // Sums have no levels.
    for (name, kind, format) in formats().filter(|(_, _, format)| *format != MomentFormat::Summed) {
        println!("\n| {name} | {} |", LEVELS.map(|level| format!("level {level}")).join(" | "));
        for slope in [5.0, 30.0, 60.0, 70.0] {
            let cells = LEVELS.map(|level| {
                let moments = Moments::new(kind, format);
                let moments = moments.read(moments.linear, true);
                let width = f64::from(level).exp2();
                let mut filtered =
                    Filtered::new(&Plane::new(slope, 45.0), moments, 1.5, 2.0 * f64::from(level.ceil()).exp2());
                filtered.drawn.frame.uniforms.views[0].pixel_from_render = [0.0, 0.0, 0.0, width as f32];
                filtered.shadow()
            });
            println!("| {slope} | {} |", cells.map(|shadow| format!("{:.3}", 100.0 * shadow)).join(" | "));
            if !(cells.iter().all(|shadow| *shadow <= MOST)) {
                broken.push(format!("{name}, {slope}°: {cells:?}"));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Sides whose halves are odd at some level: 125, 375, 1023, and one that is halved to the end.
const SIDES: [u32; 4] = [1000, 1500, 1023, 1024];

/// Half of an odd side is not where it is looked up: levels end there, and a plane that nothing shades stays lit in a
/// picture of few pixels. (At level 4 of 1000 texels it was 38 % lit.)
#[test]
fn planes_in_levels_of_odd_sides_do_not_shade_themselves() {
    for side in SIDES {
        let prefilter = Prefilter::of(Moments::new(MomentKind::Variance, MomentFormat::Float32).read(false, true));
        let remix = Remix { encoding: Encoding::Moments(prefilter), ..techniques::ssm() };
        let mut input = FitInput { map: MapBudget::one(side), ..Plane::input() };
        input.camera.viewport = UVec2::splat(12);
        let plane = Plane::new(60.0, 45.0);
        let drawn = Drawn::new(&plane.model, &input, &remix);
        let levels = drawn.frame.uniforms.views[0].moments[1];
        let expected = side.trailing_zeros().min(6);
        assert!(levels <= expected as f32, "{side}: level {levels} of {expected}");
        assert!(side != 1024 || levels > 4.0, "the picture asks for {levels} levels");
        let place = |index: u32| (f64::from(index) / f64::from(POINTS - 1) * 2.0 - 1.0) * 0.4 * HALF;
        let points = (0..POINTS * POINTS).map(|index| DVec2::new(place(index % POINTS), place(index / POINTS)));
        let points: Vec<DVec3> = points.map(|at| plane.at(at)).filter(|at| at.y.abs() <= 0.5 * HALF).collect();
        let lit = |at: &DVec3| f64::from(drawn.lit(at.as_vec3(), plane.normal.as_vec3()));
        let least = points.iter().map(lit).fold(1.0, f64::min);
        println!("side {side}: level {levels}, least light {least:.4} of {} points", points.len());
        assert!(least >= 1.0 - MOST, "{side}: {least}");
    }
}
