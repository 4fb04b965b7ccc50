//! What is drawn into each map: all that casts into it, and little else.

use antumbra::lab::subject::Knowledge;
use antumbra::{Remix, ShadowTechnique, ShadowView, techniques};
use glam::{DVec3, DVec4};

use crate::{Place, over_built_in, over_shared};

/// Side of each map, texels.
const SIDE: u32 = 1024;

/// Most objects that are drawn for each one that has to be, over all cases.
const MOST_DRAWN: f64 = 1.15;

/// By how much a triangle has to be inside for its object to count as a caster, shares of the window: matrices are f32.
const INSIDE: f64 = 1e-5;

/// The half-spaces of a view's window in render space, less a hair: left, right, below, above, and before the farthest
/// receiver. Casters may lie any distance towards the light.
fn window(view: &ShadowView) -> [DVec4; 5] {
    let rows = view.clip_from_render.as_dmat4().transpose();
    let (x, y, w) = (rows.x_axis, rows.y_axis, rows.w_axis * (1.0 - INSIDE));
    let depth = view.depth_from_render.as_dvec4();
    [w + x, w - x, w + y, w - y, DVec4::W * (1.0 - INSIDE) - depth]
}

/// Whether any part of a triangle is inside all half-spaces: what is left of it after one clip after the other.
fn reaches(triangle: [DVec3; 3], planes: &[DVec4]) -> bool {
    let mut polygon: Vec<DVec4> = triangle.iter().map(|corner| corner.extend(1.0)).collect();
    for plane in planes {
        let mut inside = Vec::with_capacity(polygon.len() + 1);
        for (index, &to) in polygon.iter().enumerate() {
            let from = polygon[(index + polygon.len() - 1) % polygon.len()];
            let [before, after] = [from, to].map(|corner| plane.dot(corner));
            if (before >= 0.0) != (after >= 0.0) {
                inside.push(from + (to - from) * (before / (before - after)));
            }
            if after >= 0.0 {
                inside.push(to);
            }
        }
        polygon = inside;
    }
    !polygon.is_empty()
}

/// Objects over views.
#[derive(Clone, Copy, Default)]
struct Tally {
    objects: usize,
    drawn: usize,
    exact: usize,
    missed: usize,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.objects += other.objects;
        self.drawn += other.drawn;
        self.exact += other.exact;
        self.missed += other.missed;
    }

    fn over_exact(self) -> f64 {
        self.drawn as f64 / self.exact.max(1) as f64
    }
}

fn count(place: &Place, view: &ShadowView) -> Tally {
    let (planes, model) = (window(view), &place.subject.model);
    let casts = |triangles: std::ops::Range<usize>| {
        triangles
            .into_iter()
            .any(|triangle| reaches(model.corners(triangle).map(|corner| corner - place.setting.origin), &planes))
    };
    let mut tally = Tally::default();
    for (object, triangles) in place.subject.objects.iter().zip(&model.objects) {
        let (drawn, exact) = (view.cull.may_cast(&object.bounds), casts(triangles.clone()));
        let add = Tally {
            objects: 1,
            drawn: usize::from(drawn),
            exact: usize::from(exact),
            missed: usize::from(exact && !drawn),
        };
        tally.add(add);
    }
    tally
}

/// Prints what one technique draws in one case.
fn check(place: &Place, name: &str, remix: &Remix, knowledge: Knowledge) -> Tally {
    let seen = if knowledge == Knowledge::Bounds { Vec::new() } else { place.setting.visible_points(place.subject) };
    let input = place.setting.input(place.subject, &seen, remix.wgsl_key(), SIDE);
    let frame = remix.fit(&input).expect("a legal case");
    let views: Vec<Tally> = frame.views.iter().map(|view| count(place, view)).collect();
    let mut all = Tally::default();
    for view in &views {
        all.add(*view);
    }
    let of_view = |view: &Tally| format!("{}/{}", view.drawn, view.exact);
    println!(
        "| {} | {name} | {} | {} | {} | {:.3} | {:.3} |",
        place.name,
        place.subject.objects.len(),
        place.subject.model.triangles.len(),
        views.iter().map(of_view).collect::<Vec<_>>().join(", "),
        all.drawn as f64 / all.objects.max(1) as f64,
        all.over_exact()
    );
    all
}

#[test]
fn views_draw_all_casters_and_few_others() {
    println!("Objects drawn into each map of {SIDE}, and those with a triangle in its window.");
    println!("| case | technique | objects | triangles | drawn/exact of each view | of all | of exact |");
    println!("|---|---|--:|--:|---|--:|--:|");
    let techniques =
        [("pssm", techniques::pssm(), Knowledge::Bounds), ("cascades", techniques::cascades(), Knowledge::Points)];
    for (set, shared) in [("shared cases", true), ("built-in viewpoints", false)] {
        let (mut all, mut cases) = (Tally::default(), 0);
        let mut add = |place: &Place| {
            cases += 1;
            for (name, remix, knowledge) in &techniques {
                all.add(check(place, name, remix, *knowledge));
            }
        };
        if shared {
            over_shared(&mut add);
        } else {
            over_built_in(&mut add);
        }
        println!(
            "{set}: {} objects drawn, {} exact: {:.3}, {} missed",
            all.drawn,
            all.exact,
            all.over_exact(),
            all.missed
        );
        assert_eq!(all.missed, 0, "{set}: objects that cast are culled");
        assert!(cases == 0 || all.exact > 0, "{set}: nothing casts at all");
        assert!(cases == 0 || all.over_exact() <= MOST_DRAWN, "{set}: {} drawn for each", all.over_exact());
    }
}
