//! Depth splits in pictures against ray-traced truth, on the software renderer: bands between maps, moving cameras,
//! rank among single maps, and what is drawn into each map. On built-in viewpoints, and on the shared cases where
//! `ANTUMBRA_SCENES` names the folder of scenes beside them.

#[path = "../support/mod.rs"]
mod support;

mod casters;
mod drawn;
mod ordering;
mod seams;
mod shimmer;

use antumbra::lab::case::Case;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::cpu::Visible;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::lab::truth::{Truth, TruthCache};

/// Width and height of pictures, pixels: half the thesis's. Larger ones take longer to trace, smaller ones show fewer
/// pixels in bands.
const PICTURE: [u32; 2] = [400, 300];

/// Scenes that need no files.
const BUILT_IN: [&str; 2] = ["treeline", "sparse-city"];

/// A case in a small picture, ready for the software renderer.
struct Place<'a> {
    name: String,
    case: Case,
    subject: &'a Subject,
    setting: Setting,
    visible: Visible,
}

impl<'a> Place<'a> {
    fn new(scene: &str, case: &Case, subject: &'a Subject) -> Self {
        let case = Case { viewport: PICTURE, ..case.clone() };
        let setting = Setting::of(&case);
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        // Shared cases are named after their scene already.
        let name =
            if case.folder.as_os_str().is_empty() { format!("{scene} {}", case.name) } else { case.name.clone() };
        Self { name, case, subject, setting, visible }
    }

    fn truth(&self) -> Truth {
        TruthCache::default().get(&self.case, &self.subject.model, &|| {}).0
    }
}

/// Runs `check` over all viewpoints of the built-in scenes.
fn over_built_in(mut check: impl FnMut(&Place)) {
    for scene in BUILT_IN {
        let assignment = Assignment::of_scene(scene).expect("built in");
        for case in &assignment.cases {
            check(&Place::new(scene, case, &assignment.subject));
        }
    }
}

/// Runs `check` over the shared cases.
fn over_shared(mut check: impl FnMut(&Place)) {
    for path in support::shared_cases() {
        let assignment = Assignment::of_case(&path).expect("a legal case");
        check(&Place::new(&assignment.scene, &assignment.cases[0], &assignment.subject));
    }
}
