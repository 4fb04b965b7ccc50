//! Four biases in three kinds of map, over one picture: what each leaves of acne, leaks and detachment.

use super::case::Case;
use super::cpu::{self, Visible};
use super::metrics::detachment::{Contact, contacts, detachment};
use super::metrics::{Scores, mask_from_bytes};
use super::subject::{Setting, Subject};
use super::truth::{Truth, TruthCache};
use crate::{Bias, DepthLaw, Light, Remix, ShadowTechnique, Warp};

/// Side of the map, texels.
pub const SIDE: u32 = 1024;

/// Share of the valid pixels in false shadow away from edges that a bias set by hand may leave: what is hardly seen.
/// Less makes constants several times larger, for the sake of a few walls.
pub const ACNE: f64 = 1e-3;

/// A kind of map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// Every caster, linear depth over w ([`DepthLaw::Projective`]).
    Projective,
    /// Every caster, linear depth.
    Linear,
    /// Back faces alone, linear depth.
    BackFaces,
}

impl Map {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Projective, Self::Linear, Self::BackFaces];

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Projective => "projective depth",
            Self::Linear => "linear depth",
            Self::BackFaces => "back faces only",
        }
    }
}

/// A way to bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// No bias.
    None,
    /// [`Bias::Manual`] with `depth_world` alone.
    Constant,
    /// [`Bias::Manual`] with `slope_texels` alone.
    SlopeScaled,
    /// [`Bias::Automatic`].
    Automatic,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::None, Self::Constant, Self::SlopeScaled, Self::Automatic];

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
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
pub enum Goal {
    /// [`ACNE`].
    Unseen,
    /// No more than the automatic bias leaves in the same map.
    AsAutomatic,
}

/// One cell of the matrix.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The map.
    pub map: Map,
    /// The bias.
    pub way: Way,
    /// How much acne it may leave, for ways with a strength.
    pub goal: Goal,
    /// World units or texels, for ways that have one.
    pub strength: f32,
    /// False, where no strength left little enough acne; that of the largest one is shown.
    pub enough: bool,
    /// `false_interior` of the scores, 0 to 1.
    pub acne: f64,
    /// `leak_interior` of the scores, 0 to 1.
    pub leak: f64,
    /// `wrong_center` of the scores, 0 to 1.
    pub wrong: f64,
    /// Mean detachment of contacts, pixels.
    pub detached_px: f64,
    /// Share of contacts that are detached, 0 to 1.
    pub detached: f64,
    /// The picture: 255 lit, 0 in shadow, row 0 on top.
    pub mask: Vec<u8>,
}

/// One picture and its matrix.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Scene and case.
    pub name: String,
    /// Warp of the maps, as reports call it.
    pub warp: &'static str,
    /// Contacts of casters and receivers.
    pub contacts: usize,
    /// Pixels that the light can reach.
    pub valid: usize,
    /// Its cells.
    pub cells: Vec<Cell>,
}

impl Picture {
    /// The cell of a map, a bias and a goal.
    #[must_use]
    pub fn cell(&self, map: Map, way: Way, goal: Goal) -> Option<&Cell> {
        self.cells.iter().find(|cell| (cell.map, cell.way, cell.goal) == (map, way, goal))
    }

    /// Whether two kinds of map gave the same pictures.
    #[must_use]
    pub fn same(&self, a: Map, b: Map) -> bool {
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

/// Draws a case, with the focused or warped map that `warp` makes, unguarded; `on_cell` sees every cell.
///
/// # Errors
/// The light is not directional, a fit was refused, or `on_cell` said so.
pub fn picture(
    subject: &Subject,
    case: &Case,
    maps: &[Map],
    (called, warp): (&'static str, Warp),
    on_cell: &mut dyn FnMut(&Cell, &Truth) -> Result<(), String>,
) -> Result<Picture, String> {
    let (truth, _) = TruthCache::default().get(case, &subject.model, &|| {});
    let setting = Setting::of(case);
    let Light::Directional { travel } = setting.light else { return Err("the light is not directional".to_owned()) };
    let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
    let (backs, found) = (subject.back_faces(travel), contacts(case, &truth));
    let studio = Studio { subject, backs, setting, visible, truth, found, warp };
    let mut cells = Vec::new();
    for map in maps {
        let automatic = studio.draw(*map, Way::Automatic, 0.0)?.acne;
        for way in Way::ALL {
            let goals: &[_] =
                if way.strengths().len() > 1 { &[Goal::Unseen, Goal::AsAutomatic] } else { &[Goal::Unseen] };
            for goal in goals {
                let most = if *goal == Goal::Unseen { ACNE } else { automatic };
                let cell = Cell { goal: *goal, ..studio.tuned(*map, way, most)? };
                on_cell(&cell, &studio.truth)?;
                cells.push(cell);
            }
        }
    }
    let (contacts, valid) = (studio.found.len(), studio.truth.valid_count());
    Ok(Picture { name: format!("{}/{}", subject.model.name, case.name), warp: called, contacts, valid, cells })
}

impl Studio<'_> {
    /// The least strength that leaves at most so much acne, or the largest one; by halving the range, which finds the
    /// least where acne falls with every step. Where it does not, one that leaves so little, and whose neighbour below
    /// does not.
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
