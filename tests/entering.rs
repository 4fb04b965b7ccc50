//! A large building enters the picture (figure 15 of the thesis): texels of maps that are fitted to the objects in view
//! change at once, those of maps that are fitted to the scene do not.

use antumbra::lab::entering::largest_jumps;
use antumbra::techniques;

#[test]
fn a_building_that_enters_changes_no_texel_at_once() {
    let greedy = largest_jumps(&techniques::pssm(), true).expect("legal");
    for (name, remix) in
        [("pssm", techniques::pssm()), ("smra", techniques::smra()), ("smra-plus", techniques::smra_plus())]
    {
        let steady = largest_jumps(&remix, false).expect("legal");
        println!("{name}: {steady:?}, {:.4} of greedy pssm's {greedy:?}", steady.any / greedy.any);
        assert!(steady.any <= 0.1 * greedy.any, "{name}: {steady:?} against {greedy:?}");
        assert_eq!(steady.gained_or_lost, 0, "{name}: a place without a map");
        // What stays is measured: texels under a turning head change a little.
        assert!(steady.same_map > 1e-6 && steady.same_map <= steady.any, "{name}: {steady:?}");
    }
    // The building matters: texels of maps that are fitted to it grow by a third in a single frame.
    assert!(greedy.any > 0.33, "{greedy:?}");
}
