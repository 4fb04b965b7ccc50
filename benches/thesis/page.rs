//! The page of the thesis.

use std::fmt::Write as _;

use crate::ablation;
use crate::claims;
use crate::classes;
use crate::duel::Set;
use crate::measure::Results;
use crate::pictures::Shown;
use crate::plus;
use crate::programme::{Named, PLUS, SCENES, SHOWN, STEP_SIDE, main_techniques, shared_techniques};
use crate::times;

const HEAD: &str = "# The thesis, run again

J. Abrantes de Oliveira, *Analysis and proposal of a shadow mapping remix approach* (Universidade do Minho), chapters 4 and 5, with ray-traced
truth beside every picture. This page is written by the command below; every number on it comes from that run, and so does every sentence that a
number decides, but for the printed marks and times of the thesis and the scores of two engines, which are constants of the bench.
";

const SETTING: &str = "
## Setting

800×600 pixels, field of view 45°, planes at 1 and 50 (*treeline*, 111 000 triangles) and 15 and 5000 (*sparse-city*, 33 000 triangles): the
thesis's numbers, scenes built anew after its descriptions. Techniques as the thesis has them: *SSM* is one map of the whole scene, *TSM*
one trapezoid without a guard, *PSSM* three maps by practical splits with λ = ½, *VSM* the standard map filtered, *SMRA* all of these with
½ where the light grazes. *TSM, guarded* and *VSM, focused* are the `tsm` and `vsm` of this crate; *PSSM + TSM* is SMRA without filter and
grazing rule; *SMRA plus* is the `smra-plus` of this crate, with four maps of the size, and SMRA with three; *PSSM, 4 maps* and *SMRA, 4 maps*
are those with a fourth. What has one map is drawn with maps of twice the largest size as well, which have the texels of four of the largest.

*Mean error*: mean absolute difference from the area truth over valid pixels; *excess*: that above a perfect hard-edged mask's; *wrong*: more than
half off the truth at the pixel's centre; *leak*, *acne*: light, or shadow, where there is none, more than two pixels from any edge.
";

/// What the pictures by size are in the thesis, scene by scene.
const SIZES_AS: [&str; 2] =
    ["57 to 62 have them", "63 to 68 have them (the thesis's text has 65 for PSSM where 66 is meant: erratum TH-16)"];

const TABLE_ONE: &str = "
## Table 1: which artefacts are left

A number for each class, with the mark of the thesis (✓ tackled, ✗ present, – does not have it) behind it; the least is the best. Built-in scenes, all
viewpoints, maps of the smallest size unless the line says otherwise. *The light grazes*: from 80° on. *Jump*: from frame to frame in
the middle of the picture, at six depths, in a scene of its own, which the tests have as well (`lab::entering`): ground in tiles, a palm, and a
large building that enters while the head turns (figure 15); where planes move, a place may be served by another map.
";

const TABLE_TWO: &str = "
## Table 2: time
";

/// All of it. Pictures lie in `thesis/` beside it.
pub(crate) fn page(meta: &[(&str, String)], results: &Results, shown: [&Shown; 2]) -> Result<String, String> {
    let mut text = HEAD.to_owned();
    text.push('\n');
    for (name, value) in meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    text.push_str(SETTING);
    let built_in = Set { records: &results.records, shared: false };
    let shared = Set { records: &results.records, shared: true };
    viewpoints(&mut text, built_in);
    figures(&mut text, built_in);
    main_table(&mut text, built_in, shared, shown[0]);
    smra_plus(&mut text, built_in, shared, shown[1]);
    text.push_str(TABLE_ONE);
    classes::table_one(&mut text, built_in)?;
    classes::about_table_one(&mut text, built_in)?;
    text.push_str(TABLE_TWO);
    times::table_two(&mut text, built_in);
    let _ = writeln!(
        text,
        "\n## One change at a time\n\nMaps of {STEP_SIDE}, mean over all viewpoints of the built-in scenes. *To*: the step that is changed; *÷ before*: mean error over that \
         step's, geometric mean. *Maps*: how many were drawn. Total: fit, casters, filter and receivers, medians of turns as in table 2 (at least {}), ± half the distance between \
         their quartiles, both means over viewpoints. Filters of moments are three texels wide, with mips.",
        ablation::least_turns(built_in)
    );
    ablation::table(&mut text, built_in);
    Ok(text)
}

/// Where the pictures are taken, row by row.
fn viewpoints(text: &mut String, set: Set) {
    let names = |scene: &str| {
        let these = set.of(PLUS, set.sizes().first().copied()).filter(|record| record.scene == scene);
        these.map(|record| record.case.as_str()).collect::<Vec<_>>().join(", ")
    };
    let rows = SCENES.map(|scene| format!("*{scene}* {}", names(scene)));
    let _ = writeln!(text, "\n![Viewpoints](thesis/viewpoints.jpg)\n\nViewpoints, row by row: {}.", rows.join("; "));
}

fn figures(text: &mut String, set: Set) {
    let sizes = set.sizes();
    let smallest = sizes.first().copied().unwrap_or_default();
    text.push_str(
        "\n## Figures\n\nLambert's cosine times the light that each technique lets through, at half the size.\n",
    );
    for ((scene, case), figures) in SHOWN.into_iter().zip(SIZES_AS) {
        let _ = writeln!(
            text,
            "\n![{scene} by technique](thesis/{scene}-techniques.jpg)\n\n*{scene}/{case} at {smallest}, as figures 47, 48, 51 and 53 to 56 have it: no shadows, one technique at a time, and the \
             truth.*\n\n![{scene}, maps](thesis/{scene}-maps.jpg)\n\n*{scene}/{case}, what lies behind it. Above, as figures 49 and 50 have it, maps with the contrast stretched to what is in them, \
             dark near to the light, pale blue where nothing is drawn: the standard map, in it what is seen (orange), the camera's frustum (white), and what TSM's map covers (violet); then SSM's, TSM's, and the first one of \
             SMRA plus. Below, as figure 52 has it: the truth, and in the colour of the map that serves a pixel (orange, blue, green, purple from the first on; grey: none) PSSM and SMRA \
             plus at {smallest}.*\n\n![{scene} by technique and size](thesis/{scene}-sizes.jpg)\n\n*{scene}/{case}, techniques by size of map, as figures {figures}, and SMRA plus.*"
        );
    }
}

fn main_table(text: &mut String, built_in: Set, shared: Set, shown: &Shown) {
    text.push_str("\n## Errors\n");
    for scene in SCENES {
        let smallest = built_in.sizes().first().copied();
        let views = built_in.of(PLUS, smallest).filter(|record| record.scene == scene).count();
        let _ = writeln!(text, "\n### {scene}, mean over {views} viewpoints");
        claims::table(text, built_in, Some(scene), &names(main_techniques()));
    }
    if shared.all().next().is_some() {
        let views = shared.of(PLUS, shared.sizes().first().copied()).count();
        let _ = writeln!(text, "\n### Shared cases, mean over {views}");
        claims::table(text, shared, None, &names(shared_techniques()));
    }
    text.push_str("\n### Far better than any of the contributors?\n");
    claims::far_superior(text, built_in);
    if shared.all().next().is_some() {
        text.push_str("\nThe same over the shared cases:\n");
        claims::far_superior(text, shared);
    }
    text.push_str("\n### What the trapezoids do\n\n");
    claims::trapezoids(text, built_in, shown);
}

fn names(techniques: Vec<Named>) -> Vec<&'static str> {
    techniques.into_iter().map(|(name, _)| name).collect()
}

fn smra_plus(text: &mut String, built_in: Set, shared: Set, worst: &Shown) {
    text.push_str(
        "\n## SMRA plus against the best of the others\n\nThe others are SSM, TSM, TSM guarded, PSSM, VSM, VSM focused and SMRA; at equal texels, one map of twice the side, or PSSM and SMRA with \
         four.\n",
    );
    plus::against_the_best(text, built_in);
    plus::look_at_worst(text, built_in, worst);
    text.push_str("\nPicture by picture:\n");
    plus::by_picture(text, built_in);
    if shared.all().next().is_some() {
        text.push_str(
            "\n### On the shared cases\n\nThe others are SSM, TSM, PSSM, VSM and SMRA, at equal texels as above.\n",
        );
        plus::against_the_best(text, shared);
        text.push_str("\nPicture by picture:\n");
        plus::by_picture(text, shared);
        text.push_str(
            "\n### Against two engines\n\nRoot mean square error against the area truth. Bevy 0.19.1 with four cascades and its Gaussian filter; three.js 0.187 with four cascades (CSM \
             addon), practical splits and PCF, distance and biases tuned on these cases. Their numbers are constants here, measured once with another ray tracer.\n",
        );
        plus::against_engines(text, shared);
    }
}
