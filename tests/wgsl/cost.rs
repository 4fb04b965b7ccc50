//! What each key's lookup is made of: `docs/SHADERS.md`, which is written by this test and must be what it would write.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::{env, fs};

use antumbra::transpile::Shader;
use antumbra::transpile::naga::{self, Expression, Statement};
use antumbra::{Grazing, MapShape, Moments, Pcf, Select, Texel, WgslKey, wgsl};

use crate::host::PLACES;
use crate::walkers::{any_statement, calls};

/// What a function computes, all that it calls included, as often as it calls them; what a loop repeats counts once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cost {
    arithmetic: usize,
    samples: usize,
    loads: usize,
    loops: usize,
}

impl Cost {
    fn of(function: &naga::Function) -> Self {
        let mut cost = Self::default();
        for (_, expression) in function.expressions.iter() {
            match expression {
                Expression::Binary { .. }
                | Expression::Unary { .. }
                | Expression::Math { .. }
                | Expression::Relational { .. }
                | Expression::Select { .. }
                | Expression::As { .. } => cost.arithmetic += 1,
                Expression::ImageSample { .. } => cost.samples += 1,
                Expression::ImageLoad { .. } => cost.loads += 1,
                _ => {}
            }
        }
        cost.loops += usize::from(any_statement(&function.body, &|one| matches!(one, Statement::Loop { .. })));
        cost
    }

    fn and(self, other: Self) -> Self {
        Self {
            arithmetic: self.arithmetic + other.arithmetic,
            samples: self.samples + other.samples,
            loads: self.loads + other.loads,
            loops: self.loops + other.loops,
        }
    }
}

/// Cost of `antumbra_visibility`, the functions that it reaches, and those of the text that it does not.
fn cost(key: WgslKey) -> (Cost, usize, Vec<String>) {
    let shader = Shader::parse(&wgsl::module(key, PLACES[0])).unwrap();
    let functions = &shader.module.functions;
    // naga keeps functions in order of definition: callees are there already.
    let mut costs: HashMap<_, (Cost, std::collections::HashSet<_>)> = HashMap::new();
    for (handle, function) in functions.iter() {
        let (mut sum, mut reached) = (Cost::of(function), std::collections::HashSet::from([handle]));
        for callee in calls(&function.body) {
            let (other, others) = &costs[&callee];
            sum = sum.and(*other);
            reached.extend(others);
        }
        costs.insert(handle, (sum, reached));
    }
    let (root, _) = functions.iter().find(|(_, f)| f.name.as_deref() == Some("antumbra_visibility")).unwrap();
    let (cost, reached) = &costs[&root];
    let unused = functions.iter().filter(|(handle, _)| !reached.contains(handle));
    (*cost, reached.len(), unused.filter_map(|(_, function)| function.name.clone()).collect())
}

fn row(text: &mut String, name: &str, key: WgslKey) {
    let (cost, functions, _) = cost(key);
    let Cost { arithmetic, samples, loads, loops } = cost;
    let _ = writeln!(text, "| {name} | {functions} | {arithmetic} | {samples} | {loads} | {loops} |");
}

const HEAD: &str = "# What lookups are made of

What `antumbra_visibility` is made of for a key, all that it calls included, as naga's intermediate representation has it: functions,
arithmetic operations (scalar or vector), texture samples, texture loads, loops. What a loop repeats counts once. This page is written by
`ANTUMBRA_WRITE=1 cargo test --test wgsl cost`; without the variable that test says whether it is still true.
";

const COLUMNS: &str = "\n| key | functions | arithmetic | samples | loads | loops |\n|---|--:|--:|--:|--:|--:|\n";

fn page() -> String {
    let one = WgslKey::default();
    let mut text = HEAD.to_owned();
    text.push_str("\n## One affine map, by what a texel stores\n");
    text.push_str(COLUMNS);
    for filter in Pcf::ALL {
        row(&mut text, &format!("depth, {}", filter.name()), WgslKey { filter, ..one });
    }
    for moments in Moments::all() {
        let read = match (moments.linear, moments.mips) {
            (true, false) => "sampled",
            (true, true) => "sampled, mips",
            (false, false) => "loaded",
            (false, true) => "loaded, mips",
        };
        let name = format!("{} {}, {read}", moments.kind().name(), moments.format().name());
        row(&mut text, &name, WgslKey { texel: Texel::Moments(moments), ..one });
    }
    text.push_str("\n## By shape, with the default filter\n");
    text.push_str(COLUMNS);
    for shape in MapShape::ALL {
        row(&mut text, &format!("{shape:?}"), WgslKey { shape, ..one });
    }
    text.push_str("\n## By the way a map is found among four affine ones, with the default filter\n");
    text.push_str(COLUMNS);
    for (select, blend) in Select::ALL.into_iter().flat_map(|select| [(select, false), (select, true)]) {
        let blended = if blend { ", blended" } else { "" };
        row(&mut text, &format!("{select:?}{blended}"), WgslKey { maps: 4, select, blend, ..one });
    }
    text.push_str("\n## By the rule for grazing light, one affine map with the default filter\n");
    text.push_str(COLUMNS);
    for grazing in Grazing::ALL {
        row(&mut text, &format!("{grazing:?}"), WgslKey { grazing, ..one });
    }
    text
}

#[test]
fn cost_of_every_key_is_as_documented() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/SHADERS.md");
    let page = page();
    if env::var_os("ANTUMBRA_WRITE").is_some() {
        fs::write(path, &page).expect("a writable page");
    }
    let written = fs::read_to_string(path).unwrap_or_default();
    assert!(page == written, "docs/SHADERS.md is out of date: ANTUMBRA_WRITE=1 cargo test --test wgsl cost");
}

/// A key's text holds nothing that its lookups, its casters and their engine's own stages do not use.
#[test]
fn texts_hold_what_their_keys_need() {
    // What engines call besides.
    let called = [
        "antumbra_caster",
        "antumbra_caster_depth",
        "antumbra_place",
        "antumbra_lit",
        "antumbra_visible",
        "antumbra_visible_noisy",
    ];
    for key in crate::keys::covering() {
        let (_, _, unused) = cost(key);
        let unknown: Vec<_> = unused.iter().filter(|name| !called.contains(&name.as_str())).collect();
        assert!(unknown.is_empty(), "{key:?}: {unknown:?}");
    }
}
