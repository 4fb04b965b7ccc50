//! Keys for checks that are too slow for all of them.

use antumbra::{MapShape, Pcf, Select, WgslKey};

/// Fewest, usual and most maps of several.
const COUNTS: [u8; 3] = [2, 4, 8];

/// Every key of one map; of several, every way to find the map among few, some and most of them in every shape, with
/// the default filter: of how it filters, the text that selects knows nothing but the reach.
pub(crate) fn chosen() -> impl Iterator<Item = WgslKey> {
    let is_one_of_several = |key: &WgslKey| COUNTS.contains(&key.maps) && key.filter == Pcf::Hardware2x2;
    WgslKey::all().filter(move |key| key.maps == 1 || is_one_of_several(key))
}

/// The choice can fail: it has all that it promises.
#[test]
fn chosen_keys_have_every_choice() {
    let keys: Vec<_> = chosen().collect();
    let one = Pcf::ALL.len() * MapShape::ALL.len();
    assert_eq!(keys.len(), one + COUNTS.len() * Select::ALL.len() * 2 * MapShape::ALL.len());
}
