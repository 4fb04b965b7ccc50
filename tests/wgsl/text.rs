//! The text itself: names, what it may not use, what it costs, and its layouts.

use std::mem::offset_of;

use antumbra::transpile::Shader;
use antumbra::transpile::naga::{self, Expression, Statement, TypeInner};
use antumbra::{
    Grazing, MAX_VIEWS, MapShape, Moments, Pcf, Select, ShadowUniforms, Texel, ViewUniforms, WgslKey, wgsl,
};

use crate::host::{PLACES, has_two_stages, host, lookups};
use crate::keys::covering;
use crate::libraries;
use crate::walkers::{any_statement, samples};

#[test]
fn no_bindings_no_entry_points_no_overrides() {
    for (key, text, shader) in libraries() {
        assert_eq!(shader.module.global_variables.len(), 0, "{key:?}");
        assert_eq!(shader.module.entry_points.len(), 0, "{key:?}");
        assert_eq!(shader.module.overrides.len(), 0, "{key:?}");
        assert!(!text.contains('#') && !text.contains("enable ") && !text.contains("requires "), "{key:?}");
    }
}

#[test]
fn every_item_has_the_prefix() {
    let prefixed = |name: &str| ["antumbra_", "Antumbra", "ANTUMBRA_"].iter().any(|prefix| name.starts_with(prefix));
    for (key, _, shader) in libraries() {
        let module = &shader.module;
        let functions = module.functions.iter().filter_map(|(_, function)| function.name.clone());
        let constants = module.constants.iter().filter_map(|(_, constant)| constant.name.clone());
        let structs = module.types.iter().filter_map(|(_, ty)| ty.name.clone());
        let names: Vec<String> = functions.chain(constants).chain(structs).collect();
        assert!(names.len() >= 8, "{key:?}: {names:?}");
        for name in names {
            assert!(prefixed(&name), "{key:?}: {name}");
        }
    }
    // What the generator adds.
    for key in covering() {
        let shader = Shader::parse(&wgsl::module(key, PLACES[0])).unwrap();
        let variables: Vec<_> =
            shader.module.global_variables.iter().map(|(_, variable)| variable.name.clone()).collect();
        assert_eq!(variables.len(), wgsl::BINDING_COUNT as usize, "{key:?}");
        for name in variables.into_iter().flatten().chain(functions(key)) {
            assert!(prefixed(&name), "{key:?}: {name}");
        }
    }
}

/// Composers rename members that end in a digit, and reserve the double underscore.
#[test]
fn names_survive_composers() {
    for (key, text, shader) in libraries() {
        for (_, ty) in shader.module.types.iter() {
            let TypeInner::Struct { members, .. } = &ty.inner else { continue };
            for member in members {
                let name = member.name.as_deref().unwrap_or("");
                assert!(!name.ends_with(|last: char| last.is_ascii_digit()), "{key:?}: {name}");
            }
        }
        assert!(!text.contains("__"), "{key:?}");
    }
}

#[test]
fn no_derivatives_and_no_pointers() {
    for (key, _, shader) in libraries() {
        for (_, function) in shader.module.functions.iter() {
            for (_, expression) in function.expressions.iter() {
                let implicit = match expression {
                    Expression::Derivative { .. } => true,
                    Expression::ImageSample { level, .. } => {
                        matches!(level, naga::SampleLevel::Auto | naga::SampleLevel::Bias(_))
                    }
                    _ => false,
                };
                assert!(!implicit, "{key:?}: {expression:?}");
            }
            for argument in &function.arguments {
                let inner = &shader.module.types[argument.ty].inner;
                assert!(!matches!(inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }), "{key:?}");
            }
        }
    }
}

/// Of a series, two terms are sampled at a time, from layers of an array.
fn is_series(key: WgslKey) -> bool {
    matches!(key.texel, Texel::Moments(moments) if moments.layers() > 1)
}

/// One map costs neither a loop nor an array of maps.
#[test]
fn one_lookup_is_straight_code() {
    for key in WgslKey::all().filter(|key| key.maps == 1 && !is_series(*key)) {
        // The points of a disc come one by one: once, and once more where casters are searched for.
        let loops = if !key.filter.is_disc() {
            0
        } else if key.filter.reads_depths() {
            2
        } else {
            1
        };
        let shader = Shader::parse(&host(key, PLACES[0])).unwrap().keep(lookups(key)).unwrap();
        assert!(shader.module.functions.len() >= 3, "{key:?}: nothing was looked at");
        for (_, ty) in shader.module.types.iter() {
            assert!(!matches!(ty.inner, TypeInner::Array { .. } | TypeInner::BindingArray { .. }), "{key:?}: {ty:?}");
        }
        let has_loop = |block| any_statement(block, &|statement| matches!(statement, Statement::Loop { .. }));
        let with_loops = shader.module.functions.iter().filter(|(_, function)| has_loop(&function.body)).count();
        assert_eq!(with_loops, loops, "{key:?}");
    }
}

/// The cost of a filter, in texture samples, and of finding one map among several: one lookup, or two where neighbours
/// by depth are blended. By containment there is one in a loop, which ends at the first map that holds the receiver,
/// or, with blending, at the last one that has a share.
#[test]
fn samples_per_lookup() {
    for key in covering() {
        let shader = Shader::parse(&wgsl::module(key, PLACES[0])).unwrap();
        let expected = match (key.texel, key.filter) {
            (Texel::Moments(moments), _) if !moments.linear => 0,
            // In a loop over the points of a disc.
            (Texel::Moments(_), _) | (_, Pcf::Point | Pcf::Hardware2x2 | Pcf::Disc | Pcf::Pcss) => 1,
            (_, Pcf::Box3x3 | Pcf::Pixel) => 4,
            (_, Pcf::Box5x5) => 9,
            (_, Pcf::Box7x7) => 16,
        };
        let points = if key.filter.is_disc() { constant_u32(&shader.module, "ANTUMBRA_DISC_TAPS") } else { 1 };
        assert!(matches!(key.texel, Texel::Moments(_)) || key.filter.samples() == expected as u32 * points, "{key:?}");
        assert_eq!(samples(&shader.module, "antumbra_visible"), expected, "{key:?}");
        let lookups = if key.select == Select::Depth && key.blend { 2 } else { 1 };
        assert_eq!(samples(&shader.module, "antumbra_visibility"), lookups * expected, "{key:?}");
    }
}

/// A constant of a module, whole.
fn constant_u32(module: &naga::Module, name: &str) -> u32 {
    let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).unwrap();
    match module.global_expressions[constant.init] {
        Expression::Literal(naga::Literal::U32(value)) => value,
        ref other => panic!("{name} is {other:?}"),
    }
}

/// Functions that a key's whole text defines.
fn functions(key: WgslKey) -> Vec<String> {
    let shader = Shader::parse(&wgsl::module(key, PLACES[0])).unwrap();
    shader.module.functions.iter().filter_map(|(_, function)| function.name.clone()).collect()
}

/// The lookup in two stages is for one map in which it is linear in position, and for no others; each key has one
/// lookup, and one way to find the map among several.
#[test]
fn two_stages_are_for_one_affine_map_alone() {
    for key in covering() {
        let functions = functions(key);
        let has = |name: &str| functions.iter().any(|function| function == name);
        let affine = key.shape == MapShape::Affine;
        assert_eq!([has("antumbra_place"), has("antumbra_lit")], [has_two_stages(key); 2], "{key:?}");
        assert_eq!(has("antumbra_lookup"), affine, "{key:?}");
        assert_eq!(has("antumbra_index"), key.maps > 1 && key.select == Select::Depth, "{key:?}");
        assert_eq!(has("antumbra_room"), key.maps > 1 && key.select == Select::Finest, "{key:?}");
        assert_eq!(has("antumbra_lookup_projective"), !affine, "{key:?}");
        let noisy = key.texel == Texel::Depth && key.filter.is_disc();
        assert_eq!([has("antumbra_visibility_noisy"), has("antumbra_visible_noisy")], [noisy; 2], "{key:?}");
        let grazed = key.grazing != Grazing::Off;
        assert_eq!([has("antumbra_grazing"), has("antumbra_mapped")], [grazed; 2], "{key:?}");
        for name in ["antumbra_visibility", "antumbra_visible", "antumbra_caster", "antumbra_caster_depth"] {
            assert!(has(name), "{key:?}: {name}");
        }
    }
}

/// Keys go through the whole product of their choices, each once.
#[test]
fn keys_are_all_there() {
    let keys: Vec<_> = WgslKey::all().collect();
    let several = (MAX_VIEWS - 1) * Select::ALL.len() * 2;
    let filters = Pcf::ALL.len() + Moments::all().count();
    assert_eq!(keys.len(), filters * MapShape::ALL.len() * (1 + several) * Grazing::ALL.len());
    assert_eq!(keys.iter().collect::<std::collections::HashSet<_>>().len(), keys.len());
    // There is room for the fragments of each.
    assert!(keys.iter().all(|key| wgsl::library(*key).len() > 5));
    assert!(keys.iter().all(|key| key.maps > 1 || (key.select == Select::Depth && !key.blend)));
    for (filter, shape) in Pcf::ALL.iter().flat_map(|filter| MapShape::ALL.map(|shape| (*filter, shape))) {
        assert_eq!(
            keys.iter().filter(|key| **key == WgslKey { filter, shape, ..WgslKey::default() }).count(),
            1,
            "{filter:?} {shape:?}"
        );
    }
}

/// The uniform block that is uploaded is the block that is read, member by member.
#[test]
fn layouts_agree() {
    let view = [
        ("u_from_render", offset_of!(ViewUniforms, u_from_render)),
        ("v_from_render", offset_of!(ViewUniforms, v_from_render)),
        ("w_from_render", offset_of!(ViewUniforms, w_from_render)),
        ("depth_from_render", offset_of!(ViewUniforms, depth_from_render)),
        ("texel", offset_of!(ViewUniforms, texel)),
        ("bias", offset_of!(ViewUniforms, bias)),
        ("rect", offset_of!(ViewUniforms, rect)),
        ("across_u", offset_of!(ViewUniforms, across_u)),
        ("across_v", offset_of!(ViewUniforms, across_v)),
        ("across_w", offset_of!(ViewUniforms, across_w)),
        ("domain", offset_of!(ViewUniforms, domain)),
        ("pixel_from_render", offset_of!(ViewUniforms, pixel_from_render)),
        ("moments", offset_of!(ViewUniforms, moments)),
    ];
    assert_eq!(size_of::<ViewUniforms>(), 208);
    for (key, _, shader) in libraries() {
        assert_eq!(members(&shader.module, "AntumbraView"), (view.to_vec(), size_of::<ViewUniforms>()), "{key:?}");
        let (uniforms, span) = members(&shader.module, "AntumbraUniforms");
        let name = if key.maps > 1 { "views" } else { "view" };
        assert_eq!(uniforms, [(name, offset_of!(ShadowUniforms, views))], "{key:?}");
        assert_eq!(span, size_of::<ViewUniforms>() * usize::from(key.maps), "{key:?}: bytes that are bound");
        // An array's elements lie as far apart as they do in memory.
        let strides: Vec<_> = shader.module.types.iter().filter_map(|(_, ty)| stride(&ty.inner)).collect();
        let expected: &[_] = if key.maps > 1 { &[(u32::from(key.maps), size_of::<ViewUniforms>())] } else { &[] };
        assert_eq!(strides, expected, "{key:?}");
    }
}

#[test]
fn reaches_agree() {
    for (key, _, shader) in libraries() {
        let value = |name: &str| {
            let module = &shader.module;
            let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).unwrap();
            match module.global_expressions[constant.init] {
                Expression::Literal(naga::Literal::F32(value)) => f64::from(value),
                ref other => panic!("{name} is {other:?}"),
            }
        };
        assert_eq!(value("ANTUMBRA_REACH").to_bits(), key.filter.reach().to_bits(), "{key:?}");
        assert_eq!(value("ANTUMBRA_TAP_REACH").to_bits(), key.filter.tap_reach().to_bits(), "{key:?}");
    }
}

/// Number of an array's elements, and how far apart they are.
fn stride(inner: &TypeInner) -> Option<(u32, usize)> {
    match inner {
        TypeInner::Array { size: naga::ArraySize::Constant(count), stride, .. } => {
            Some((count.get(), *stride as usize))
        }
        _ => None,
    }
}

/// Member names with offsets, and the size, of a struct.
fn members<'a>(module: &'a naga::Module, name: &str) -> (Vec<(&'a str, usize)>, usize) {
    let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|member| (member.name.as_deref().unwrap_or(""), member.offset as usize)).collect();
    (members, *span as usize)
}
