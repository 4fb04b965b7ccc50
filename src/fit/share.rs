//! How many texels each of several maps gets, and where they are: squares that are the layer's side divided by powers
//! of two, packed into layers.
//!
//! ```text
//! (1)  e_i(k) = T_i / (2 t(k))          side of a texel after k halvings, world units; t: texels over the window
//! (2)  p_i(k) = e_i(k) · pixels / z_i   the same in the picture; z: mean depth of what is seen in the slice
//! (3)  E = Σ_i s_i e_i(k_i)             predicted picture error; s: share of what is seen in the slice
//! ```
//!
//! T is the extent of a slice across the light, width and height together. [`Share::EqualError`] halves maps as long as
//! (2) stays below the worst one's at full side; [`Share::LeastError`] halves, one after the other, the map in which
//! (3) rises least for each texel that is freed, until all fit.
//!
//! # References
//! - Lloyd, Tuft, Yoon & Manocha, *Warping and partitioning for low error shadow maps*, 2006: texels by the error of
//!   each partition.
//! - Knowlton, *A fast storage allocator*, 1965: the buddy system; in descending order its blocks leave no holes.

use arrayvec::ArrayVec;
use glam::{DVec3, UVec2};

use crate::content::Tile;
use crate::fit::cuts::{Cut, Cuts};
use crate::fit::snap::{self, Stabilise};
use crate::fit::view::Fitter;
use crate::frame::MAX_VIEWS;
use crate::report::Why;
use crate::scene::{DepthRange, ENOUGH_SAMPLES};
use crate::split::equal_error::Cost;

/// How many of the texels each map of a depth split gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Share {
    /// A layer each, all of it. There are at most as many maps as `map.layers`.
    #[default]
    Equal,
    /// No more than each needs for the worst texels in the picture to be no worse: the side is halved, up to three
    /// times, where that leaves texels that are no larger in the picture than those of the worst map of the frame.
    /// Saves texels, and now and then layers; the picture is hardly worse. Splits of equal error leave little to save.
    EqualError,
    /// All the texels of `map.layers` layers, where they lower the predicted picture error most: sides are halved, up
    /// to three times, until the maps fit. There can be more maps than layers.
    ///
    /// For budgets of few layers: four maps in one layer show fewer wrong pixels than one map of it. Where each map can
    /// have a layer, more and smaller maps in the same texels show more (`docs/SPLITS.md`).
    LeastError,
}

/// Most halvings of a side. With fewer, little is saved on maps that hardly matter; with more, they are smaller than
/// what moves between two frames changes.
const MOST_HALVINGS: u32 = 3;

/// By which factor, less one, a choice may be wrong for a map to keep the side that it had. At 0 sizes flip back and
/// forth with the camera, and with them edges; at 1 a map keeps a side that is wrong by a halving.
const HYSTERESIS: f64 = 0.1;

/// Cells in a layer: the smallest tiles.
const CELLS: u32 = 1 << (2 * MOST_HALVINGS);

/// Halvings of each map.
type Halvings = ArrayVec<u32, MAX_VIEWS>;

impl Share {
    /// Why a map has a tile instead of a layer.
    pub(crate) fn why(self, Tile { side, .. }: Tile) -> Why {
        match self {
            Self::LeastError => Why::TexelsElsewhere { side },
            Self::Equal | Self::EqualError => Why::TexelsEnough { side },
        }
    }
}

/// What is known of a slice before it is laid out.
#[derive(Clone, Copy, Debug)]
struct Slice {
    /// Width and height of its window, together, world units: twice (1), times t.
    size: f64,
    /// Share of what is seen.
    seen: f64,
    /// Mean eye depth of what is seen there, world units.
    distance: f64,
    /// Halvings in the previous frame.
    before: Option<u32>,
}

impl Fitter<'_> {
    /// Most maps that there are texels for.
    pub(crate) fn most_maps(&self) -> u32 {
        let layers = self.input.map.layers;
        if self.how.share == Share::LeastError { layers << (2 * self.most_halvings()) } else { layers }
    }

    /// The tile of each slice; none where each has a layer of its own. O(slices · edges + samples).
    pub(crate) fn tiles(&self, cuts: &Cuts, range: DepthRange) -> ArrayVec<Tile, MAX_VIEWS> {
        let slices = || self.predicted(cuts, range);
        match self.how.share {
            Share::Equal => ArrayVec::new(),
            Share::EqualError => self.packed(&self.equal_error(&slices())),
            Share::LeastError => self.packed(&self.least_error(&slices())),
        }
    }

    /// Halvings that leave room for the border of a filter.
    fn most_halvings(&self) -> u32 {
        let has_room = |halvings: &u32| self.texels.of_side(self.tile.of >> halvings).too_small().is_none();
        (1..=MOST_HALVINGS).take_while(has_room).last().unwrap_or(0)
    }

    /// Texels over the window of a map.
    fn over_window(&self, halvings: u32) -> f64 {
        self.texels.of_side(self.tile.of >> halvings).over_window()
    }

    fn predicted(&self, cuts: &Cuts, range: DepthRange) -> ArrayVec<Slice, MAX_VIEWS> {
        // Maps that stand still must not follow what is seen.
        let still = self.how.stabilise == Stabilise::SnapTexels;
        let camera = &self.input.camera;
        let samples = if still { &[] } else { self.input.scene.visible_points };
        let cost = Cost::new(&cuts.profile, camera, samples, range);
        let slice = |&Cut { split, depth: DepthRange { near, far } }: &Cut| {
            let of_body = cuts.profile.size(near, far);
            let snapped = snap::size(&camera.projection, DepthRange { near, far });
            let size = if still && snapped.is_finite() { snapped } else { of_body };
            let before = self.input.previous.and_then(|frame| frame.views.iter().find(|view| view.split == split));
            let before = before.map(|view| view.place.tile.halvings());
            Slice { size, seen: cost.seen(near, far), distance: 0.5 * (near + far), before }
        };
        let mut slices: ArrayVec<Slice, MAX_VIEWS> = cuts.slices.iter().map(slice).collect();
        // Whether a snapped map is one of the whole scene hangs on its texels: sizes among other maps are no history.
        if still && slices.iter().any(|slice| slice.before.is_none()) {
            slices.iter_mut().for_each(|slice| slice.before = None);
        }
        // Where in its depths things are: in their middle as long as nobody knows better.
        let mut count = [ENOUGH_SAMPLES; MAX_VIEWS];
        for depth in samples.iter().map(|sample| camera.eye_depth(*sample, DVec3::ZERO)) {
            let holds = |Cut { depth: DepthRange { near, far }, .. }: &Cut| (*near..=*far).contains(&depth);
            if let Some(number) = cuts.slices.iter().position(holds) {
                count[number] += 1.0;
                slices[number].distance += (depth - slices[number].distance) / count[number];
            }
        }
        slices
    }

    /// Each map by (2) as small as the worst one allows.
    fn equal_error(&self, slices: &[Slice]) -> Halvings {
        let spreads = self.input.camera.projection.spreads();
        let error = |slice: &Slice| slice.size / if spreads { slice.distance } else { 1.0 };
        let worst = slices.iter().map(error).fold(0.0, f64::max);
        let (most, full) = (self.most_halvings(), self.over_window(0));
        let halvings = |slice: &Slice| {
            // The most that leave texels no larger than `limit` times the worst ones.
            let within = |limit: f64| {
                let is_enough = |halvings: &u32| error(slice) * full <= limit * worst * self.over_window(*halvings);
                (1..=most).rev().find(is_enough).unwrap_or(0)
            };
            let tolerance = 1.0 + HYSTERESIS;
            slice.before.map_or(within(1.0), |before| before.clamp(within(1.0 / tolerance), within(tolerance)))
        };
        slices.iter().map(halvings).collect()
    }

    /// All maps by (3) in the layers that there are.
    fn least_error(&self, slices: &[Slice]) -> Halvings {
        let room = self.input.map.layers.min(MAX_VIEWS as u32) * CELLS;
        let most = self.most_halvings();
        let error = |slice: &Slice, halvings: u32| slice.seen * slice.size / self.over_window(halvings);
        // What one more halving costs, for each cell that it frees.
        let price = |slice: &Slice, halvings: u32| {
            let freed = cells(halvings) - cells(halvings + 1);
            (error(slice, halvings + 1) - error(slice, halvings)) / f64::from(freed)
        };
        let mut chosen: Halvings = slices.iter().map(|_| 0).collect();
        while area(&chosen) > room {
            let open = slices.iter().zip(&mut chosen).filter(|(_, halvings)| **halvings < most);
            let Some((_, least)) = open.min_by(|a, b| price(a.0, *a.1).total_cmp(&price(b.0, *b.1))) else { break };
            *least += 1;
        }
        // The last halvings may have freed more than was wanted.
        loop {
            let left = room.saturating_sub(area(&chosen));
            let fits = |halvings: u32| halvings > 0 && cells(halvings - 1) - cells(halvings) <= left;
            let open = slices.iter().zip(&mut chosen).filter(|(_, halvings)| fits(**halvings));
            let Some((_, dearest)) = open.max_by(|a, b| price(a.0, *a.1 - 1).total_cmp(&price(b.0, *b.1 - 1))) else {
                break;
            };
            *dearest -= 1;
        }
        // What there was, as long as that is hardly worse.
        let kept: Halvings =
            slices.iter().zip(&chosen).map(|(slice, now)| slice.before.unwrap_or(*now).min(most)).collect();
        let total =
            |all: &Halvings| slices.iter().zip(all).map(|(slice, halvings)| error(slice, *halvings)).sum::<f64>();
        if area(&kept) <= room && total(&kept) <= (1.0 + HYSTERESIS) * total(&chosen) { kept } else { chosen }
    }

    /// Tiles of these sizes, the largest first: each begins where the one before ends, which is a multiple of its size.
    fn packed(&self, halvings: &Halvings) -> ArrayVec<Tile, MAX_VIEWS> {
        let of = self.tile.of;
        let mut tiles: ArrayVec<Tile, MAX_VIEWS> = halvings.iter().map(|_| Tile::whole(0, of)).collect();
        let mut end = 0;
        for size in 0..=MOST_HALVINGS {
            for (tile, _) in tiles.iter_mut().zip(halvings).filter(|(_, halvings)| **halvings == size) {
                *tile = Tile { layer: end / CELLS, corner: corner(end % CELLS, of), side: of >> size, of };
                end += cells(size);
            }
        }
        tiles
    }
}

/// Cells of a map after this many halvings.
const fn cells(halvings: u32) -> u32 {
    CELLS >> (2 * halvings)
}

/// Cells of all maps.
fn area(all: &[u32]) -> u32 {
    all.iter().map(|halvings| cells(*halvings)).sum()
}

/// Upper left corner of a cell, which are numbered quarter by quarter, and within each in the same order. Odd sides
/// leave a row and a column of texels over.
fn corner(cell: u32, side: u32) -> UVec2 {
    (1..=MOST_HALVINGS).fold(UVec2::ZERO, |corner, halvings| {
        let quarter = cell / cells(halvings) % 4;
        corner + UVec2::new(quarter % 2, quarter / 2) * (side >> halvings)
    })
}
