//! What is photographed: techniques as the thesis has them, its scenes, and the shared cases.

use antumbra::lab::comparison::Assignment;
use antumbra::lab::subject::case_of;
use antumbra::lab::viewpoints::thesis_viewpoints;
use antumbra::{DepthSplits, Encoding, Grazing, Pcf, Remix, Scheme, Select, Share, Split, Warp, techniques};

/// The thesis's two scenes, as they are called here.
pub(crate) const SCENES: [&str; 2] = ["treeline", "sparse-city"];

/// The viewpoint of each scene that is shown in pictures and timed: the thesis's figures look at trees in a line with
/// the sun across, and at a small figure in a large city.
pub(crate) const SHOWN: [(&str, &str); 2] = [("treeline", "across"), ("sparse-city", "figure")];

/// Side of the maps of the ablation, texels: the thesis's middle one.
pub(crate) const STEP_SIDE: u32 = 1024;

pub(crate) const SSM: &str = "SSM";
pub(crate) const TSM: &str = "TSM";
pub(crate) const PSSM: &str = "PSSM";
pub(crate) const VSM: &str = "VSM";
pub(crate) const SMRA: &str = "SMRA";
pub(crate) const PLUS: &str = "SMRA plus";
pub(crate) const UNFILTERED: &str = "PSSM + TSM";
pub(crate) const GUARDED: &str = "TSM, guarded";
pub(crate) const FOCUSED: &str = "VSM, focused";
pub(crate) const PSSM_FOUR: &str = "PSSM, 4 maps";
pub(crate) const SMRA_FOUR: &str = "SMRA, 4 maps";

/// What the thesis mixes.
pub(crate) const CONTRIBUTORS: [&str; 4] = [SSM, TSM, PSSM, VSM];

/// What every comparison has.
pub(crate) const SIX: [&str; 6] = [SSM, TSM, PSSM, VSM, SMRA, PLUS];

/// A technique, and how many times as wide its maps are as those of SMRA plus.
pub(crate) type Rival = (&'static str, u32);

/// What SMRA plus has to beat with maps of the same side: the thesis's five, and two of them in the better form that
/// this crate has. It has four maps, parallel splits three, the others one.
pub(crate) const SAME_SIDE: [Rival; 7] =
    [(SSM, 1), (TSM, 1), (GUARDED, 1), (PSSM, 1), (VSM, 1), (FOCUSED, 1), (SMRA, 1)];

/// And at equal texels: one map of twice the side, or four maps.
pub(crate) const EQUAL_TEXELS: [Rival; 7] =
    [(SSM, 2), (TSM, 2), (GUARDED, 2), (VSM, 2), (FOCUSED, 2), (PSSM_FOUR, 1), (SMRA_FOUR, 1)];

/// A technique by the name it has on the page.
pub(crate) type Named = (&'static str, Remix);

/// Techniques of the main table. The thesis filters the standard map, and does not limit trapezoids.
pub(crate) fn main_techniques() -> Vec<Named> {
    vec![
        (SSM, techniques::ssm()),
        (TSM, Remix { guard: false, ..techniques::tsm() }),
        (GUARDED, techniques::tsm()),
        (PSSM, techniques::pssm()),
        (PSSM_FOUR, in_four_maps(techniques::pssm())),
        (VSM, Remix { warp: Warp::Uniform, ..techniques::vsm() }),
        (FOCUSED, techniques::vsm()),
        (UNFILTERED, Remix { encoding: Encoding::default(), grazing: Grazing::Off, ..techniques::smra() }),
        (SMRA, techniques::smra()),
        (SMRA_FOUR, in_four_maps(techniques::smra())),
        (PLUS, techniques::smra_plus()),
    ]
}

/// The same splits with as many maps as SMRA plus has.
fn in_four_maps(remix: Remix) -> Remix {
    let Split::Depth(splits) = remix.split else { return remix };
    Remix { split: Split::Depth(DepthSplits { maps: 4, ..splits }), ..remix }
}

/// The six alone.
pub(crate) fn six() -> Vec<Named> {
    main_techniques().into_iter().filter(|(name, _)| SIX.contains(name)).collect()
}

/// Those that take part in the shared cases: the six, and what they are compared with at equal texels.
pub(crate) fn shared_techniques() -> Vec<Named> {
    let there = |name: &str| SIX.contains(&name) || [PSSM_FOUR, SMRA_FOUR].contains(&name);
    main_techniques().into_iter().filter(|(name, _)| there(name)).collect()
}

/// Those of them that are drawn with maps of twice the largest side as well.
pub(crate) fn wide(techniques: &[Named]) -> Vec<Named> {
    techniques.iter().copied().filter(|(name, _)| EQUAL_TEXELS.contains(&(*name, 2))).collect()
}

/// A step of the ablation: one change to the step before it.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    /// What changes, and the step that it changes.
    pub(crate) change: &'static str,
    pub(crate) from: &'static str,
    pub(crate) remix: Remix,
}

/// One change at a time, from the standard map to SMRA, and from parallel splits to SMRA plus.
pub(crate) fn steps() -> Vec<Step> {
    let step = |name, from, change, remix| Step { name, change, from, remix };
    let splits = |select| {
        let splits = DepthSplits { maps: 4, scheme: Scheme::EqualError, select, ..DepthSplits::DEFAULT };
        Remix { split: Split::Depth(splits), ..techniques::pssm() }
    };
    let finest = splits(Select::Finest);
    let filtered = |encoding| Remix { encoding, ..finest };
    let unfiltered = Remix { encoding: Encoding::default(), grazing: Grazing::Off, ..techniques::smra() };
    vec![
        step(SSM, "", "one map of the whole scene", techniques::ssm()),
        step("focused", SSM, "the map is fitted to what is in view (`fsm`)", techniques::fsm()),
        step(PSSM, "focused", "3 maps, practical splits", techniques::pssm()),
        step(UNFILTERED, PSSM, "a trapezoid for each", unfiltered),
        step(
            "+ variance",
            UNFILTERED,
            "variance, blurred over 3 texels, mips",
            Remix { grazing: Grazing::Off, ..techniques::smra() },
        ),
        step(SMRA, "+ variance", "½ where the light grazes", techniques::smra()),
        step(PSSM_FOUR, PSSM, "4 maps, not 3", in_four_maps(techniques::pssm())),
        step("equal error", PSSM_FOUR, "planes of equal predicted error", splits(Select::Depth)),
        step(FINEST, "equal error", "the finest map that holds a receiver", finest),
        step("PCF 3×3", FINEST, "filter: 4 samples over 3×3 texels", filtered(Encoding::Depth(Pcf::Box3x3))),
        step("variance", FINEST, "filter: variance", filtered(techniques::vsm().encoding)),
        step(
            "exponential variance",
            FINEST,
            "filter: exponential variance, 4 numbers",
            filtered(techniques::evsm().encoding),
        ),
        step("four moments", FINEST, "filter: four moments", filtered(techniques::msm().encoding)),
        step(PLUS, FINEST, "filter: 4 samples over the pixel", techniques::smra_plus()),
        step(
            "warps",
            PLUS,
            "the least-error warp for each",
            Remix { warp: Warp::LeastError, ..techniques::smra_plus() },
        ),
        step(
            "shared texels",
            PLUS,
            "texels shared by equal error",
            Remix { share: Share::EqualError, ..techniques::smra_plus() },
        ),
    ]
}

/// The step that filters are tried on.
pub(crate) const FINEST: &str = "finest";

/// Turns that are timed: where the thesis has its pictures, there from a side of maps on that takes long, and of the
/// ablation in other views. Fewer leave quartiles to chance, more take long.
const TURNS: u32 = 5;
const TURNS_LARGE: u32 = 3;
const TURNS_STEP: u32 = 3;
const TURNS_QUICK: u32 = 2;
const LARGE: u32 = 2048;

/// Which of it all is photographed.
pub(crate) struct Programme {
    pub(crate) quick: bool,
}

impl Programme {
    /// Sides of maps, texels.
    pub(crate) fn sizes(&self) -> &'static [u32] {
        if self.quick { &[512, 1024] } else { &[512, 1024, 2048] }
    }

    /// Side of the wide maps, which have the texels of four of the largest.
    pub(crate) fn wide_size(&self) -> u32 {
        2 * self.sizes().last().copied().unwrap_or(STEP_SIDE)
    }

    /// Timed turns of a picture, of which medians are reported; 0 where no time is. Where the thesis has its pictures
    /// they are in its Table 2, at one size in the ablation.
    pub(crate) fn turns(&self, shown: bool, size: u32) -> u32 {
        let turns = match (shown, size) {
            (true, ..LARGE) => TURNS,
            (true, _) => TURNS_LARGE,
            (false, STEP_SIDE) => TURNS_STEP,
            (false, _) => 0,
        };
        if self.quick { turns.min(TURNS_QUICK) } else { turns }
    }

    /// The thesis's scenes.
    pub(crate) fn built_in(&self) -> Result<Vec<Assignment>, String> {
        let of = |scene: &str| {
            let mut assignment = Assignment::of_scene(scene)?;
            assignment.cases = thesis_viewpoints(scene).iter().map(|view| case_of(view, scene)).collect();
            assignment.cases.retain(|case| !self.quick || SHOWN.contains(&(scene, case.name.as_str())));
            Ok(assignment)
        };
        SCENES.into_iter().map(of).collect()
    }

    /// The cases beside the folder of scenes; none without one.
    pub(crate) fn shared(&self) -> Result<Vec<Assignment>, String> {
        let mut all = Assignment::shared()?;
        all.truncate(if self.quick { 2 } else { all.len() });
        Ok(all)
    }
}
