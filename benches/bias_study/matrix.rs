//! Four biases in three kinds of map, in two pictures.

use antumbra::lab::case::Case;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::metrics::detachment::{Contact, contacts, detachment};
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::lab::subject::{Setting, Subject};
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{Bias, DepthLaw, Light, Remix, ShadowTechnique, Warp};

/// Side of the map, texels.
pub(crate) const SIDE: u32 = 1024;

/// Share of the valid pixels in false shadow away from edges that a bias set by hand may leave: what is hardly seen.
/// Less makes constants several times larger, for the sake of a few walls.
pub(crate) const ACNE: f64 = 1e-3;

/// A kind of map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Map {
    Projective,
    Linear,
    BackFaces,
}

impl Map {
    pub(crate) const ALL: [Self; 3] = [Self::Projective, Self::Linear, Self::BackFaces];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Projective => "projective depth",
            Self::Linear => "linear depth",
            Self::BackFaces => "back faces only",
        }
    }
}

/// A way to bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    None,
    Constant,
    SlopeScaled,
    Automatic,
}

impl Way {
    pub(crate) const ALL: [Self; 4] = [Self::None, Self::Constant, Self::SlopeScaled, Self::Automatic];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Constant => "constant",
            Self::SlopeScaled => "slope-scaled",
            Self::Automatic => "automatic",
        }
    }

    /// The bias of a strength, where a way has one.
    fn bias(self, strength: f32) -> Bias {
        let (depth_world, slope_texels) = match self {
            Self::Automatic => return Bias::Automatic,
            Self::None => (0.0, 0.0),
            Self::Constant => (strength, 0.0),
            Self::SlopeScaled => (0.0, strength),
        };
        Bias::Manual { depth_world, slope_texels, normal_texels: 0.0 }
    }

    /// The strengths that are tried, from the least one on, by factors of √2.
    fn strengths(self) -> Vec<f32> {
        let from = |least: f32, count: u16| (0..count).map(|step| least * 2_f32.powf(0.5 * f32::from(step))).collect();
        match self {
            Self::None | Self::Automatic => vec![0.0],
            Self::Constant => from(0.01, 32),
            Self::SlopeScaled => from(0.125, 20),
        }
    }
}

/// How much acne a strength may leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Goal {
    /// [`ACNE`].
    Unseen,
    /// No more than the automatic bias leaves in the same map.
    AsAutomatic,
}

/// One cell of the matrix.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) map: Map,
    pub(crate) way: Way,
    pub(crate) goal: Goal,
    /// World units or texels, for ways that have one.
    pub(crate) strength: f32,
    /// False, where no strength left little enough acne; that of the largest one is shown.
    pub(crate) enough: bool,
    pub(crate) acne: f64,
    pub(crate) leak: f64,
    pub(crate) wrong: f64,
    pub(crate) detached_px: f64,
    pub(crate) detached: f64,
    mask: Vec<u8>,
}

/// One picture and its matrix.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub(crate) name: String,
    pub(crate) warp: &'static str,
    pub(crate) contacts: usize,
    pub(crate) valid: usize,
    pub(crate) cells: Vec<Cell>,
}

impl Picture {
    pub(crate) fn cell(&self, map: Map, way: Way, goal: Goal) -> Option<&Cell> {
        self.cells.iter().find(|cell| (cell.map, cell.way, cell.goal) == (map, way, goal))
    }

    /// Whether two kinds of map gave the same pictures.
    pub(crate) fn same(&self, a: Map, b: Map) -> bool {
        let masks = |map: Map| self.cells.iter().filter(move |cell| cell.map == map).map(|cell| &cell.mask);
        masks(a).eq(masks(b))
    }
}

/// What one picture is drawn with.
struct Studio<'a> {
    subject: &'a Subject,
    backs: Subject,
    setting: Setting,
    visible: Visible,
    truth: Truth,
    found: Vec<Contact>,
    warp: Warp,
}

/// Draws both.
pub(crate) fn pictures() -> Result<Vec<Picture>, String> {
    let city = Assignment::of_scene("sparse-city")?;
    let case = |name: &str| city.cases.iter().find(|case| case.name == name).ok_or(format!("no case {name}"));
    let (figure, across) = (case("figure")?, case("across")?);
    let strongest = Warp::Perspective { pull_back: 0.0 };
    Ok(vec![
        picture(&city.subject, figure, "focused, no warp", Warp::Focused)?,
        picture(&city.subject, across, "light-space perspective, unguarded", Warp::LightSpacePerspective)?,
        picture(&city.subject, across, "perspective shadow map, unguarded", strongest)?,
    ])
}

fn picture(subject: &Subject, case: &Case, called: &'static str, warp: Warp) -> Result<Picture, String> {
    let (truth, _) = TruthCache::default().get(case, &subject.model, &|| {});
    let setting = Setting::of(case);
    let Light::Directional { travel } = setting.light else { return Err("the light is not directional".to_owned()) };
    let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
    let (backs, found) = (subject.back_faces(travel), contacts(case, &truth));
    let studio = Studio { subject, backs, setting, visible, truth, found, warp };
    let mut cells = Vec::new();
    for map in Map::ALL {
        let automatic = studio.draw(map, Way::Automatic, 0.0)?.acne;
        for way in Way::ALL {
            let goals: &[_] =
                if way.strengths().len() > 1 { &[Goal::Unseen, Goal::AsAutomatic] } else { &[Goal::Unseen] };
            for goal in goals {
                let most = if *goal == Goal::Unseen { ACNE } else { automatic };
                let cell = Cell { goal: *goal, ..studio.tuned(map, way, most)? };
                let Cell { strength, acne, leak, detached_px, .. } = cell;
                println!(
                    "{}, {called}, {map:?}, {way:?} {goal:?} {strength}: acne {acne}, leak {leak}, {detached_px} px",
                    case.name
                );
                let file = format!("{} {called} {} {} {goal:?}", case.name, map.name(), way.name());
                crate::save(&file, &cell.mask, &studio.truth)?;
                cells.push(cell);
            }
        }
    }
    let (contacts, valid) = (studio.found.len(), studio.truth.valid_count());
    Ok(Picture { name: format!("sparse-city/{}", case.name), warp: called, contacts, valid, cells })
}

impl Studio<'_> {
    /// The least strength that leaves at most so much acne, or the largest one.
    fn tuned(&self, map: Map, way: Way, most: f64) -> Result<Cell, String> {
        let strengths = way.strengths();
        let (mut low, mut high) = (0, strengths.len() - 1);
        let mut best = self.draw(map, way, strengths[high])?;
        best.enough = best.acne <= most;
        while best.enough && low < high {
            let middle = usize::midpoint(low, high);
            let cell = self.draw(map, way, strengths[middle])?;
            if cell.acne <= most {
                (high, best) = (middle, Cell { enough: true, ..cell });
            } else {
                low = middle + 1;
            }
        }
        Ok(best)
    }

    fn draw(&self, map: Map, way: Way, strength: f32) -> Result<Cell, String> {
        let depth = if map == Map::Projective { DepthLaw::Projective } else { DepthLaw::Linear };
        let remix = Remix { warp: self.warp, depth, bias: way.bias(strength), guard: false, ..Remix::default() };
        let input = self.setting.input(self.subject, &[], remix.wgsl_key(), SIDE);
        let frame = remix.fit(&input).map_err(|error| error.to_string())?;
        let casters = if map == Map::BackFaces { &self.backs } else { self.subject };
        let mask = cpu::render(casters, &self.visible, &frame, &self.setting).mask;
        let values = mask_from_bytes(&mask);
        let scores = Scores::new(&values, &self.truth).map_err(|error| error.to_string())?;
        let strips = detachment(&values, &self.truth, &self.found).map_err(|error| error.to_string())?;
        Ok(Cell {
            map,
            way,
            goal: Goal::Unseen,
            strength,
            enough: false,
            acne: scores.false_interior,
            leak: scores.leak_interior,
            wrong: scores.wrong_center,
            detached_px: strips.mean_px,
            detached: strips.share,
            mask,
        })
    }
}
