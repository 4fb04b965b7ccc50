//! The shader contract: what every text of the library promises to the engines that paste it into theirs.

use std::collections::HashMap;
use std::mem::offset_of;

use antumbra::transpile::naga::{self, Expression, Statement, TypeInner};
use antumbra::transpile::{Glsl, Shader};
use antumbra::wgsl::{self, Bindings};
use antumbra::{MapShape, Pcf, ShadowUniforms, ViewUniforms, WgslKey, gpu};

/// Every key with its library: the fragments, without bindings.
fn libraries() -> impl Iterator<Item = (WgslKey, String, Shader)> {
    WgslKey::all().map(|key| {
        let text = wgsl::library(key).join("\n");
        let shader = Shader::parse(&text).unwrap_or_else(|error| panic!("{key:?}: {error}"));
        (key, text, shader)
    })
}

/// An engine's shader around `antumbra_visibility`, with names that an engine would choose, and what a shape adds to
/// it.
fn host(key: WgslKey, bindings: Bindings) -> String {
    let engine = "
        struct View { clip_from_world: mat4x4f, depth_from_world: vec4f, eye: vec4f }
        struct Lookup { uv: vec2f }
        @group(0) @binding(0) var<uniform> view: View;
        @group(0) @binding(1) var map: texture_2d<f32>;
        @group(0) @binding(2) var compare: sampler;
        struct Fragment { @builtin(position) clip: vec4f, @location(0) position: vec3f, @location(1) normal: vec3f }
        fn lookup(at: Lookup) -> vec4f { return textureSampleLevel(map, compare, at.uv, 0.0); }
        fn filter_colour(colour: vec4f) -> vec4f { return colour * colour; }
        @vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Fragment {
            return Fragment(view.clip_from_world * vec4f(position, 1.0), position, normal);
        }
        @fragment fn fragment(in: Fragment) -> @location(0) vec4f {
            let visible = antumbra_visibility(in.position, normalize(in.normal), distance(view.eye.xyz, in.position));
            return filter_colour(lookup(Lookup(in.position.xy))) * visible;
        }";
    [wgsl::module(key, bindings).as_str(), engine, of_shape(key.shape)].concat()
}

/// Casters of an affine map are vertices alone, and its lookup can be split over two stages. Casters of a warped map
/// carry their linear depth from the vertices to the fragments, which write it.
fn of_shape(shape: MapShape) -> &'static str {
    match shape {
        MapShape::Affine => "
        @vertex fn caster(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(view.clip_from_world, position);
        }
        struct Placed { @builtin(position) clip: vec4f, @location(0) place: vec3f, @location(1) @interpolate(flat) slope: vec2f }
        @vertex fn placing(@location(0) position: vec3f, @location(1) normal: vec3f) -> Placed {
            let look = antumbra_place(position, normal);
            return Placed(view.clip_from_world * vec4f(position, 1.0), vec3f(look.uv, look.depth), look.slope);
        }
        @fragment fn placed(in: Placed) -> @location(0) vec4f {
            return vec4f(antumbra_lit(AntumbraLookup(in.place.xy, in.place.z, in.slope)));
        }",
        MapShape::ProjectiveDepth => "
        @vertex fn caster(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(view.clip_from_world, position);
        }",
        MapShape::Projective => "
        struct Thrown { @builtin(position) clip: vec4f, @location(0) depth: f32 }
        @vertex fn caster(@location(0) position: vec3f) -> Thrown {
            let clip = antumbra_caster(view.clip_from_world, position);
            return Thrown(clip, antumbra_caster_depth(view.depth_from_world, position));
        }
        @fragment fn thrown(in: Thrown) -> @builtin(frag_depth) f32 {
            return in.depth;
        }",
    }
}

/// The entry points of [`host`], all of them.
fn entries(shape: MapShape) -> &'static [&'static str] {
    match shape {
        MapShape::Affine => &["vertex", "fragment", "caster", "placing", "placed"],
        MapShape::Projective => &["vertex", "fragment", "caster", "thrown"],
        MapShape::ProjectiveDepth => &["vertex", "fragment", "caster"],
    }
}

/// The entry points that look a receiver up.
fn lookups(shape: MapShape) -> &'static [&'static str] {
    match shape {
        MapShape::Affine => &["fragment", "placing", "placed"],
        MapShape::Projective | MapShape::ProjectiveDepth => &["fragment"],
    }
}

/// Where engines put the bindings: at the front, in between, and far back.
const PLACES: [Bindings; 3] =
    [Bindings { group: 1, first: 0 }, Bindings { group: 0, first: 7 }, Bindings { group: 3, first: 900 }];

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
    for key in WgslKey::all() {
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

/// One map costs neither a loop nor an array of maps.
#[test]
fn one_lookup_is_straight_code() {
    for key in WgslKey::all() {
        let shader = Shader::parse(&host(key, PLACES[0])).unwrap().keep(lookups(key.shape)).unwrap();
        assert!(shader.module.functions.len() >= 3, "{key:?}: nothing was looked at");
        for (_, ty) in shader.module.types.iter() {
            assert!(!matches!(ty.inner, TypeInner::Array { .. } | TypeInner::BindingArray { .. }), "{key:?}: {ty:?}");
        }
        for (_, function) in shader.module.functions.iter() {
            assert!(
                !any_statement(&function.body, &|statement| matches!(statement, Statement::Loop { .. })),
                "{key:?}"
            );
        }
    }
}

/// The cost of a filter, in texture samples.
#[test]
fn samples_per_lookup() {
    for (key, _, shader) in libraries() {
        let expected = match key.filter {
            Pcf::Point | Pcf::Hardware2x2 => 1,
            Pcf::Box3x3 => 4,
            Pcf::Box5x5 => 9,
        };
        assert_eq!(samples(&shader.module, "antumbra_visible"), expected, "{key:?}");
    }
}

#[test]
fn links_into_a_host_shader() {
    for key in WgslKey::all() {
        for place in PLACES {
            let shader = Shader::parse(&host(key, place)).unwrap_or_else(|error| panic!("{key:?} {place:?}: {error}"));
            // The three bindings are where the caller wants them.
            let found: Vec<_> = shader.module.global_variables.iter().filter_map(|(_, v)| v.binding).collect();
            for binding in place.first..place.first + wgsl::BINDING_COUNT {
                let expected = naga::ResourceBinding { group: place.group, binding };
                assert_eq!(found.iter().filter(|at| **at == expected).count(), 1, "{key:?}: {expected:?} in {found:?}");
            }
            // A caster alone needs no map.
            let caster = shader.keep(&["caster"]).unwrap();
            assert_eq!(caster.module.global_variables.len(), 1, "{key:?}");
            let globals = |entry: &str| -> Vec<_> {
                let kept = shader.keep(&[entry]).unwrap();
                kept.module.global_variables.iter().filter_map(|(_, variable)| variable.name.clone()).collect()
            };
            match key.shape {
                // In two stages, vertices read the uniforms and no map, and fragments the map and no uniforms.
                MapShape::Affine => {
                    assert_eq!(globals("placing"), ["antumbra_uniforms", "view"], "{key:?}");
                    assert_eq!(globals("placed"), ["antumbra_map", "antumbra_compare"], "{key:?}");
                }
                // What casters write comes to their fragments from the vertices.
                MapShape::Projective => assert_eq!(globals("thrown"), [""; 0], "{key:?}"),
                // Here casters have no fragments.
                MapShape::ProjectiveDepth => assert_eq!(globals("caster"), ["view"], "{key:?}"),
            }
        }
    }
}

/// Functions that a key's whole text defines.
fn functions(key: WgslKey) -> Vec<String> {
    let shader = Shader::parse(&wgsl::module(key, PLACES[0])).unwrap();
    shader.module.functions.iter().filter_map(|(_, function)| function.name.clone()).collect()
}

/// The lookup in two stages is for maps in which it is linear in position, and for no others; each key has one lookup.
#[test]
fn two_stages_are_for_affine_maps_alone() {
    for key in WgslKey::all() {
        let functions = functions(key);
        let has = |name: &str| functions.iter().any(|function| function == name);
        let affine = key.shape == MapShape::Affine;
        assert_eq!([has("antumbra_place"), has("antumbra_lit"), has("antumbra_lookup")], [affine; 3], "{key:?}");
        assert_eq!(has("antumbra_lookup_projective"), !affine, "{key:?}");
        for name in ["antumbra_visibility", "antumbra_visible", "antumbra_caster", "antumbra_caster_depth"] {
            assert!(has(name), "{key:?}: {name}");
        }
    }
}

/// Keys go through the whole product of their choices, each once.
#[test]
fn keys_are_all_there() {
    let keys: Vec<_> = WgslKey::all().collect();
    assert_eq!(keys.len(), Pcf::ALL.len() * MapShape::ALL.len());
    for (filter, shape) in Pcf::ALL.iter().flat_map(|filter| MapShape::ALL.map(|shape| (*filter, shape))) {
        assert_eq!(keys.iter().filter(|key| **key == WgslKey { filter, shape }).count(), 1, "{filter:?} {shape:?}");
    }
}

#[test]
fn composes_unchanged_under_naga_oil() {
    use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};
    for (key, text, _) in libraries() {
        let mut composer = Composer::default();
        composer
            .add_composable_module(ComposableModuleDescriptor {
                source: &text,
                file_path: "antumbra.wgsl",
                as_name: Some("antumbra".to_owned()),
                ..Default::default()
            })
            .unwrap_or_else(|error| panic!("{key:?}: {error}"));
        let source = "
            #import antumbra::{AntumbraUniforms, antumbra_visible}
            @group(2) @binding(0) var<uniform> uniforms: AntumbraUniforms;
            @group(2) @binding(1) var map: texture_depth_2d;
            @group(2) @binding(2) var compare: sampler_comparison;
            @fragment fn fragment(@location(0) position: vec3f) -> @location(0) vec4f {
                return vec4f(antumbra_visible(uniforms.view, map, compare, position, vec3f(0.0, 1.0, 0.0)));
            }";
        let module = composer
            .make_naga_module(NagaModuleDescriptor { source, file_path: "host.wgsl", ..Default::default() })
            .unwrap_or_else(|error| panic!("{key:?}: {error}"));
        assert_eq!(module.entry_points.len(), 1, "{key:?}");
    }
}

#[test]
fn converts_to_other_languages() {
    for (key, _, library) in libraries() {
        let linked = Shader::parse(&host(key, PLACES[0])).unwrap();
        let stages: Vec<_> = entries(key.shape).iter().map(|entry| linked.keep(&[entry]).unwrap()).collect();
        for shader in std::iter::once(&library).chain(&stages) {
            assert_eq!(shader.spirv().unwrap()[0], 0x0723_0203, "{key:?}");
            assert!(shader.hlsl().unwrap().len() > 100, "{key:?}");
            assert!(shader.msl().unwrap().starts_with("// language: metal"), "{key:?}");
        }
        for version in Glsl::ALL {
            let text =
                library.glsl_library(version).unwrap_or_else(|error| panic!("{key:?} {version:?}: {error}")).text;
            assert!(text.contains("antumbra_visible(") && text.contains("sampler2DShadow"), "{key:?} {version:?}");
            let fragment = linked.glsl(version, "fragment").unwrap_or_else(|error| panic!("{key:?}: {error}"));
            let textures: Vec<_> = fragment.samplers.iter().map(|(_, texture)| texture.as_str()).collect();
            assert!(textures.contains(&"antumbra_map") && textures.contains(&"map"), "{key:?}: {textures:?}");
            assert!(fragment.blocks.iter().any(|(_, block)| block == "antumbra_uniforms"), "{key:?}");
            let [first, second] = match key.shape {
                MapShape::Affine => ["placing", "placed"],
                MapShape::Projective => ["caster", "thrown"],
                MapShape::ProjectiveDepth => continue,
            };
            let first = linked.glsl(version, first).unwrap_or_else(|error| panic!("{key:?}: {error}"));
            assert!(first.samplers.is_empty() && !first.blocks.is_empty(), "{key:?}: {:?}", first.samplers);
            let second = linked.glsl(version, second).unwrap_or_else(|error| panic!("{key:?}: {error}"));
            let samplers = usize::from(key.shape == MapShape::Affine);
            assert!(second.blocks.is_empty() && second.samplers.len() == samplers, "{key:?}: {:?}", second.blocks);
            let writes_depth = second.text.contains("gl_FragDepth");
            assert_eq!(writes_depth, key.shape == MapShape::Projective, "{key:?}: {}", second.text);
        }
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
    ];
    for (key, _, shader) in libraries() {
        assert_eq!(members(&shader.module, "AntumbraView"), (view.to_vec(), size_of::<ViewUniforms>()), "{key:?}");
        let (uniforms, span) = members(&shader.module, "AntumbraUniforms");
        assert_eq!(uniforms, [("view", offset_of!(ShadowUniforms, views))], "{key:?}");
        assert_eq!(span, size_of::<ViewUniforms>(), "{key:?}: {span} bytes are bound for one view");
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

/// wgpu accepts the text with the layouts of `antumbra::gpu`, without any GPU.
#[test]
fn pipelines_accept_the_layouts() {
    use gpu::wgpu;
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    for key in WgslKey::all() {
        let descriptor = gpu::ShadowMapsDescriptor { label: None, key, map: antumbra::MapBudget::one(64) };
        let maps = gpu::ShadowMaps::new(&device, &descriptor).unwrap();
        // The library's own group, and its entries behind seven of the engine's in one group.
        let own = wgsl::module(key, Bindings { group: 0, first: 0 });
        let merged = wgsl::module(key, Bindings { group: 0, first: 7 });
        let entries = gpu::layout_entries(key, 7, wgpu::ShaderStages::VERTEX_FRAGMENT);
        let layout =
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let entries = maps.bind_entries(7);
        let _ =
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        for (text, layout) in [(own, maps.bind_group_layout()), (merged, &layout)] {
            let stages: &[_] = match key.shape {
                MapShape::Affine => &[("vertex", Some("fragment")), ("placing", Some("placed")), ("vertex", None)],
                MapShape::Projective => &[("vertex", Some("fragment")), ("caster", Some("thrown"))],
                MapShape::ProjectiveDepth => &[("vertex", Some("fragment")), ("vertex", None)],
            };
            for stages in stages {
                make_pipeline(
                    &device,
                    &[&text, host_on_wgpu(key.shape)].concat(),
                    layout,
                    maps.caster_layout(),
                    *stages,
                );
            }
        }
    }
    drop(queue);
}

/// An engine's shader for [`make_pipeline`]: group 1 is `caster_bind_group`.
fn host_on_wgpu(shape: MapShape) -> &'static str {
    match shape {
        MapShape::Affine => "
        @group(1) @binding(0) var<uniform> clip_from_render: mat4x4f;
        @vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(clip_from_render, position);
        }
        @fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return vec4f(antumbra_visibility(at.xyz, vec3f(0.0, 1.0, 0.0), 1.0));
        }
        struct Placed { @builtin(position) clip: vec4f, @location(0) place: vec3f, @location(1) @interpolate(flat) slope: vec2f }
        @vertex fn placing(@location(0) position: vec3f) -> Placed {
            let look = antumbra_place(position, vec3f(0.0, 1.0, 0.0));
            return Placed(antumbra_caster(clip_from_render, position), vec3f(look.uv, look.depth), look.slope);
        }
        @fragment fn placed(in: Placed) -> @location(0) vec4f {
            return vec4f(antumbra_lit(AntumbraLookup(in.place.xy, in.place.z, in.slope)));
        }",
        MapShape::ProjectiveDepth => "
        @group(1) @binding(0) var<uniform> clip_from_render: mat4x4f;
        @vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(clip_from_render, position);
        }
        @fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return vec4f(antumbra_visibility(at.xyz, vec3f(0.0, 1.0, 0.0), 1.0));
        }",
        MapShape::Projective => "
        struct View { clip_from_render: mat4x4f, depth_from_render: vec4f }
        @group(1) @binding(0) var<uniform> view: View;
        @vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(view.clip_from_render, position);
        }
        @fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return vec4f(antumbra_visibility(at.xyz, vec3f(0.0, 1.0, 0.0), 1.0));
        }
        struct Thrown { @builtin(position) clip: vec4f, @location(0) depth: f32 }
        @vertex fn caster(@location(0) position: vec3f) -> Thrown {
            let clip = antumbra_caster(view.clip_from_render, position);
            return Thrown(clip, antumbra_caster_depth(view.depth_from_render, position));
        }
        @fragment fn thrown(in: Thrown) -> @builtin(frag_depth) f32 {
            return in.depth;
        }",
    }
}

/// A pipeline of a vertex entry point and, but for casters of affine maps, a fragment entry point. Casters write no
/// colour.
fn make_pipeline(
    device: &gpu::wgpu::Device,
    text: &str,
    maps: &gpu::wgpu::BindGroupLayout,
    casters: &gpu::wgpu::BindGroupLayout,
    (vertex, fragment): (&str, Option<&str>),
) {
    use gpu::wgpu;
    let colour = [Some(wgpu::TextureFormat::Rgba8Unorm.into())];
    let targets: &[_] = if fragment == Some("thrown") { &[] } else { &colour };
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(maps), Some(casters)],
        immediate_size: 0,
    });
    // A mismatch is a validation error, which panics here.
    let _ = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(gpu::depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    });
}

/// Member names with offsets, and the size, of a struct.
fn members<'a>(module: &'a naga::Module, name: &str) -> (Vec<(&'a str, usize)>, usize) {
    let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|member| (member.name.as_deref().unwrap_or(""), member.offset as usize)).collect();
    (members, *span as usize)
}

/// Texture samples of a function, those of the functions it calls included, as often as it calls them.
fn samples(module: &naga::Module, name: &str) -> usize {
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

fn calls(block: &naga::Block) -> Vec<naga::Handle<naga::Function>> {
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
fn any_statement(block: &naga::Block, test: &dyn Fn(&Statement) -> bool) -> bool {
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
