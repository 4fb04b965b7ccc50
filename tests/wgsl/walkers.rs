//! What a function does, all that it calls included.

use std::collections::HashMap;

use antumbra::transpile::Shader;
use antumbra::transpile::naga::{self, Expression, Statement};

/// Texture samples of a function, those of the functions it calls included, as often as it calls them.
pub(crate) fn samples(module: &naga::Module, name: &str) -> usize {
    let counts: HashMap<_, usize> = module.functions.iter().fold(HashMap::new(), |mut counts, (handle, function)| {
        let own = function.expressions.iter().filter(|(_, e)| matches!(e, Expression::ImageSample { .. })).count();
        // naga keeps functions in order of definition: callees are there already.
        let called: usize = calls(&function.body).iter().map(|callee| counts[callee]).sum();
        counts.insert(handle, own + called);
        counts
    });
    let (handle, _) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name)).unwrap();
    counts[&handle]
}

/// The functions that a block calls, as often as it does.
pub(crate) fn calls(block: &naga::Block) -> Vec<naga::Handle<naga::Function>> {
    let found = std::cell::RefCell::new(Vec::new());
    any_statement(block, &|statement| {
        if let Statement::Call { function, .. } = statement {
            found.borrow_mut().push(*function);
        }
        false
    });
    found.into_inner()
}

/// Whether any statement of a block, nested ones included, is as `test` says.
pub(crate) fn any_statement(block: &naga::Block, test: &dyn Fn(&Statement) -> bool) -> bool {
    block.iter().any(|statement| {
        test(statement)
            || match statement {
                Statement::Block(inner) => any_statement(inner, test),
                Statement::If { accept, reject, .. } => any_statement(accept, test) || any_statement(reject, test),
                Statement::Switch { cases, .. } => cases.iter().any(|case| any_statement(&case.body, test)),
                Statement::Loop { body, continuing, .. } => {
                    any_statement(body, test) || any_statement(continuing, test)
                }
                _ => false,
            }
    })
}

/// The walkers above can fail: each finds what it is for.
#[test]
fn the_walkers_see() {
    let text = "
        fn inner(map: texture_depth_2d, compare: sampler_comparison) -> f32 {
            return textureSampleCompareLevel(map, compare, vec2f(), 0.5);
        }
        fn outer(map: texture_depth_2d, compare: sampler_comparison) -> f32 {
            var sum = 0.0;
            if compare_twice() { sum += inner(map, compare) + inner(map, compare); }
            for (var i = 0; i < 2; i++) { sum += inner(map, compare); }
            return sum;
        }
        fn compare_twice() -> bool { return true; }";
    let shader = Shader::parse(text).unwrap();
    assert_eq!(samples(&shader.module, "outer"), 3);
    let outer = shader.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some("outer")).unwrap().1;
    assert!(any_statement(&outer.body, &|statement| matches!(statement, Statement::Loop { .. })));
}
