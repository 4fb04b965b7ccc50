//! What is photographed: techniques as the thesis has them, its scenes, and the shared cases.

use std::path::{Path, PathBuf};

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

/// What the thesis mixes.
pub(crate) const CONTRIBUTORS: [&str; 4] = [SSM, TSM, PSSM, VSM];

/// What every comparison has.
pub(crate) const SIX: [&str; 6] = [SSM, TSM, PSSM, VSM, SMRA, PLUS];

/// What SMRA plus has to beat: the thesis's five, and two of them in the better form that this crate has.
pub(crate) const RIVALS: [&str; 7] = [SSM, TSM, GUARDED, PSSM, VSM, FOCUSED, SMRA];

/// A technique by the name it has on the page.
pub(crate) type Named = (&'static str, Remix);

/// Techniques of the main table. The thesis filters the standard map, and does not limit trapezoids.
pub(crate) fn main_techniques() -> Vec<Named> {
    vec![
        (SSM, techniques::ssm()),
        (TSM, Remix { guard: false, ..techniques::tsm() }),
        (GUARDED, techniques::tsm()),
        (PSSM, techniques::pssm()),
        (VSM, Remix { warp: Warp::Uniform, ..techniques::vsm() }),
        (FOCUSED, techniques::vsm()),
        (UNFILTERED, Remix { encoding: Encoding::default(), grazing: Grazing::Off, ..techniques::smra() }),
        (SMRA, techniques::smra()),
        (PLUS, techniques::smra_plus()),
    ]
}

/// The six alone.
pub(crate) fn six() -> Vec<Named> {
    main_techniques().into_iter().filter(|(name, _)| SIX.contains(name)).collect()
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
    let splits = |scheme, select, enough| {
        let splits = DepthSplits { maps: 4, scheme, select, enough, ..DepthSplits::DEFAULT };
        Remix { split: Split::Depth(splits), ..techniques::pssm() }
    };
    let (practical, enough) = (Scheme::Practical { lambda: 0.5, offset: 0.0 }, DepthSplits::DEFAULT.enough);
    let finest = splits(Scheme::EqualError, Select::Finest, enough);
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
        step("4 maps", PSSM, "4 maps, not 3", splits(practical, Select::Depth, 0.0)),
        step(
            "equal error",
            "4 maps",
            "planes of equal predicted error",
            splits(Scheme::EqualError, Select::Depth, enough),
        ),
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

/// Which of it all is photographed.
pub(crate) struct Programme {
    pub(crate) quick: bool,
}

impl Programme {
    /// Sides of maps, texels.
    pub(crate) fn sizes(&self) -> &'static [u32] {
        if self.quick { &[512, 1024] } else { &[512, 1024, 2048] }
    }

    /// Turns that every technique gets where it is timed; medians are reported.
    pub(crate) fn turns(&self) -> usize {
        if self.quick { 1 } else { 3 }
    }

    /// How often a pass is drawn in its turn; medians are kept. The first one touches fresh memory.
    pub(crate) fn repetitions(&self) -> u32 {
        if self.quick { 1 } else { 3 }
    }

    /// The command line that does this again.
    pub(crate) fn command(&self) -> String {
        let scenes = if shared_scenes().is_some() { "ANTUMBRA_SCENES=<folder> " } else { "" };
        let profile = if cfg!(debug_assertions) { "test" } else { "bench" };
        format!("{scenes}cargo {profile} --bench thesis{}", if self.quick { " -- --quick" } else { "" })
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
        let Some(scenes) = shared_scenes() else { return Ok(Vec::new()) };
        let folder = scenes.join("../cases");
        let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
        paths.retain(|path| path.extension().is_some_and(|found| found == "json"));
        paths.sort();
        let kept = if self.quick { 2 } else { paths.len() };
        paths.iter().take(kept).map(|path| Assignment::of_case(path)).collect()
    }
}

/// The folder of shared scenes, where one is named.
fn shared_scenes() -> Option<PathBuf> {
    std::env::var_os("ANTUMBRA_SCENES").map(|scenes| Path::new(&scenes).to_owned())
}
