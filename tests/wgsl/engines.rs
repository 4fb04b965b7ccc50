//! The text in an engine's hands: linked, composed, translated, and made into pipelines.

use antumbra::transpile::{Glsl, Shader, naga};
use antumbra::wgsl::{self, Bindings};
use antumbra::{MapShape, WgslKey, gpu};

use crate::host::{PLACES, entries, has_two_stages, host, stages};
use crate::keys::chosen;
use crate::library;

#[test]
fn links_into_a_host_shader() {
    for key in chosen() {
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
                MapShape::Affine if has_two_stages(key) => {
                    assert_eq!(globals("placing"), ["antumbra_uniforms", "view"], "{key:?}");
                    assert_eq!(globals("placed"), ["antumbra_map", "antumbra_compare"], "{key:?}");
                }
                // What casters write comes to their fragments from the vertices.
                MapShape::Projective => assert_eq!(globals("thrown"), [""; 0], "{key:?}"),
                // Here casters have no fragments.
                MapShape::Affine | MapShape::ProjectiveDepth => assert_eq!(globals("caster"), ["view"], "{key:?}"),
            }
        }
    }
}

#[test]
fn composes_unchanged_under_naga_oil() {
    use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};
    for key in chosen() {
        let (text, _) = library(key);
        let mut composer = Composer::default();
        composer
            .add_composable_module(ComposableModuleDescriptor {
                source: &text,
                file_path: "antumbra.wgsl",
                as_name: Some("antumbra".to_owned()),
                ..Default::default()
            })
            .unwrap_or_else(|error| panic!("{key:?}: {error}"));
        let view = if key.maps > 1 { "views[1]" } else { "view" };
        let source = "
            #import antumbra::{AntumbraUniforms, antumbra_visible}
            @group(2) @binding(0) var<uniform> uniforms: AntumbraUniforms;
            @group(2) @binding(1) var map: TEXTURE;
            @group(2) @binding(2) var compare: SAMPLER;
            @fragment fn fragment(@location(0) position: vec3f) -> @location(0) vec4f {
                return vec4f(antumbra_visible(uniforms.VIEW, map, compare, position, vec3f(0.0, 1.0, 0.0)));
            }"
        .replace("TEXTURE", wgsl::texture(key))
        .replace("SAMPLER", wgsl::sampler(key))
        .replace("VIEW", view);
        let module = composer
            .make_naga_module(NagaModuleDescriptor { source: &source, file_path: "host.wgsl", ..Default::default() })
            .unwrap_or_else(|error| panic!("{key:?}: {error}"));
        assert_eq!(module.entry_points.len(), 1, "{key:?}");
    }
}

#[test]
fn converts_to_other_languages() {
    for key in chosen() {
        let (_, library) = library(key);
        let linked = Shader::parse(&host(key, PLACES[0])).unwrap();
        let stages: Vec<_> = entries(key).iter().map(|entry| linked.keep(&[entry]).unwrap()).collect();
        for shader in std::iter::once(&library).chain(&stages) {
            assert_eq!(shader.spirv().unwrap()[0], 0x0723_0203, "{key:?}");
            assert!(shader.hlsl().unwrap().len() > 100, "{key:?}");
            assert!(shader.msl().unwrap().starts_with("// language: metal"), "{key:?}");
        }
        for version in Glsl::ALL {
            // What compares with depths and reads them as well is not claimed.
            if key.filter.reads_depths() {
                assert!(library.glsl_library(version).is_err() && linked.glsl(version, "fragment").is_err(), "{key:?}");
                continue;
            }
            let text =
                library.glsl_library(version).unwrap_or_else(|error| panic!("{key:?} {version:?}: {error}")).text;
            let sampler = match wgsl::texture(key) {
                "texture_depth_2d" => "sampler2DShadow",
                "texture_depth_2d_array" => "sampler2DArrayShadow",
                "texture_2d<f32>" => "sampler2D",
                "texture_2d<u32>" => "usampler2D",
                "texture_2d_array<u32>" => "usampler2DArray",
                _ => "sampler2DArray",
            };
            assert!(text.contains("antumbra_visible(") && text.contains(sampler), "{key:?} {version:?}");
            let fragment = linked.glsl(version, "fragment").unwrap_or_else(|error| panic!("{key:?}: {error}"));
            let textures: Vec<_> = fragment.samplers.iter().map(|(_, texture)| texture.as_str()).collect();
            assert!(textures.contains(&"antumbra_map") && textures.contains(&"map"), "{key:?}: {textures:?}");
            assert!(fragment.blocks.iter().any(|(_, block)| block == "antumbra_uniforms"), "{key:?}");
            let [first, second] = match key.shape {
                MapShape::Affine if has_two_stages(key) => ["placing", "placed"],
                MapShape::Projective => ["caster", "thrown"],
                MapShape::Affine | MapShape::ProjectiveDepth => continue,
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

/// Keys whose maps a device without a GPU can make: what is particular to an adapter needs one.
fn drawable() -> impl Iterator<Item = WgslKey> {
    let particular = gpu::wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    chosen().filter(move |key| !gpu::required_features(*key).contains(particular))
}

/// wgpu accepts the text with the layouts of `antumbra::gpu`, without any GPU.
#[test]
fn pipelines_accept_the_layouts() {
    use gpu::wgpu;
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_features: drawable().map(gpu::required_features).reduce(|all, more| all | more).unwrap(),
        ..Default::default()
    });
    for key in drawable() {
        let maps = u32::from(key.maps);
        let map = antumbra::MapBudget { side: 64, layers: maps, views: maps };
        let descriptor = gpu::ShadowMapsDescriptor { label: None, key, map };
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
                MapShape::Affine if has_two_stages(key) => {
                    &[("vertex", Some("fragment")), ("placing", Some("placed")), ("caster", None)]
                }
                MapShape::Projective => &[("vertex", Some("fragment")), ("caster", Some("thrown"))],
                MapShape::Affine | MapShape::ProjectiveDepth => &[("vertex", Some("fragment")), ("caster", None)],
            };
            for stages in stages {
                make_pipeline(&device, &(text.clone() + &host_on_wgpu(key)), layout, maps.caster_layout(), *stages);
            }
        }
    }
    drop(queue);
}

/// An engine's shader for [`make_pipeline`]: group 1 is `caster_bind_group`.
fn host_on_wgpu(key: WgslKey) -> String {
    let (group, matrix) = match key.shape {
        MapShape::Affine | MapShape::ProjectiveDepth => {
            ("@group(1) @binding(0) var<uniform> clip_from_render: mat4x4f;", "clip_from_render")
        }
        MapShape::Projective => (
            "struct View { clip_from_render: mat4x4f, depth_from_render: vec4f }
            @group(1) @binding(0) var<uniform> view: View;",
            "view.clip_from_render",
        ),
    };
    let receiver = "
        @vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(MATRIX, position);
        }
        @fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return vec4f(antumbra_visibility(at.xyz, vec3f(0.0, 1.0, 0.0), 1.0));
        }"
    .replace("MATRIX", matrix);
    [group, &receiver, &stages(key, matrix, "view.depth_from_render")].concat()
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
                array_stride: 24,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
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
