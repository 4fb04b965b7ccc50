//! Keys for checks that are too slow for all of them.
#![allow(dead_code, reason = "each test file uses a part of it")]

use antumbra::{Grazing, MapShape, MomentFormat, MomentKind, Moments, Pcf, Select, Texel, WgslKey};

/// Fewest, usual and most maps of several.
const COUNTS: [u8; 3] = [2, 4, 8];

/// Every way to find the map.
const WAYS: usize = Select::ALL.len() * 2;

/// Maps of moments that differ in all that other fragments see of them: sampled, loaded, summed, and in layers.
fn different() -> [Texel; 4] {
    [
        Moments::new(MomentKind::Variance, MomentFormat::Unorm16).read(true, true),
        Moments::new(MomentKind::Hausdorff, MomentFormat::Float32).read(false, true),
        Moments::new(MomentKind::Hamburger, MomentFormat::Summed),
        Moments::new(MomentKind::Convolution, MomentFormat::Unorm8),
    ]
    .map(Texel::Moments)
}

fn is_usual(key: &WgslKey) -> bool {
    key.texel == Texel::Depth || different().contains(&key.texel)
}

/// Keys with a rule for grazing light that differ in all that its text sees of them: a disc or none, one map or several
/// and how they are found. The rest shows that depths and moments, and shapes, go with it.
fn is_grazed(key: &WgslKey) -> bool {
    let plain = key.filter == Pcf::Hardware2x2 && (key.texel == Texel::Depth || key.texel == different()[0]);
    key.grazing != Grazing::Off && (plain || key.filter == Pcf::Disc) && matches!(key.maps, 1 | 4)
}

/// Every key of maps of depths; of moments, every one of a single map, every one of four affine maps that are found by
/// containment, and in some, every other choice. All of these without a rule for grazing light; and some with it.
pub(crate) fn covering() -> impl Iterator<Item = WgslKey> {
    WgslKey::all().filter(|key| {
        if key.grazing != Grazing::Off {
            return is_grazed(key);
        }
        let four = key.maps == 4 && key.select == Select::Finest && !key.blend && key.shape == MapShape::Affine;
        key.texel == Texel::Depth || key.maps == 1 || four || (is_usual(key) && COUNTS.contains(&key.maps))
    })
}

/// Every key of one map of depths, and of one affine map of moments; every way to find the map among few, some and most
/// of them in every shape, with the default filter: of how it filters, the text that selects knows nothing but the
/// reach. All of these without a rule for grazing light; and some affine ones with it.
pub(crate) fn chosen() -> impl Iterator<Item = WgslKey> {
    WgslKey::all().filter(|key| match key.maps {
        _ if key.grazing != Grazing::Off => is_grazed(key) && key.shape == MapShape::Affine,
        1 => is_usual(key) || key.shape == MapShape::Affine,
        maps => is_usual(key) && COUNTS.contains(&maps) && key.filter == Pcf::Hardware2x2,
    })
}

/// The choices can fail: they have all that they promise.
#[test]
fn chosen_keys_have_every_choice() {
    let (shapes, moments, usual) = (MapShape::ALL.len(), Moments::all().count(), 1 + different().len());
    let depths = Pcf::ALL.len() * shapes;
    let one = depths + different().len() * (shapes - 1) + moments;
    // Two rules, for two filters and one kind of moments, of one map and of four.
    let grazed = (Grazing::ALL.len() - 1) * 3 * (1 + WAYS);
    assert_eq!(chosen().count(), one + COUNTS.len() * WAYS * shapes * usual + grazed);
    let of_depths = depths * (1 + 7 * WAYS);
    let some = different().len() * COUNTS.len() * WAYS * shapes;
    // Some of four affine maps found by containment are among the different ones.
    let four = moments - different().len();
    assert_eq!(covering().count(), of_depths + moments * shapes + some + four + grazed * shapes);
}
