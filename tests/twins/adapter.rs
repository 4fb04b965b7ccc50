//! What runs on the adapter: a map that is filled, and the library's functions over the cases.

use antumbra::gpu::{self, ShadowMaps, wgpu};
use antumbra::lab::gpu::Gpu;
use antumbra::wgsl::{self, Bindings};
use antumbra::{MapShape, Pcf, ShadowView, WgslKey};

use crate::support::compute::{compute, storage};
use crate::{Case, Outcome};

/// Draws depths into the map of a view, texel by texel.
pub(crate) fn fill(gpu: &Gpu, maps: &ShadowMaps, view: &ShadowView, depth: &[f32]) {
    let text = "
        @group(0) @binding(0) var<storage, read> depths: array<f32>;
        @vertex fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
            return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.5, 1.0);
        }
        override side: u32;
        @fragment fn write(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
            return depths[u32(at.y) * side + u32(at.x)];
        }";
    let device = gpu.device();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("fill"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let side = f64::from(maps.depth_texture().size().width);
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("fill"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(gpu::depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("write"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("side", side)],
                ..Default::default()
            },
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let depths = storage(gpu, bytemuck::cast_slice(depth));
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("fill"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: depths.as_entire_binding() }],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = maps.caster_pass(&mut encoder, view, None);
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    // The rim as well, which casters leave alone.
    let whole = maps.depth_texture().size();
    pass.set_viewport(0.0, 0.0, whole.width as f32, whole.height as f32, 0.0, 1.0);
    pass.set_scissor_rect(0, 0, whole.width, whole.height);
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.queue().submit([encoder.finish()]);
}

/// How a library is given a lookup.
const GIVEN: &str = "
    fn given(case_: Case) -> AntumbraLookup {
        return AntumbraLookup(case_.look.xy, case_.look.z, case_.slope_offset.xy); }";

/// Calls of a library whose filter has no disc.
const STEADY: &str = "
    fn visible(view: AntumbraView, position: vec3f, normal: vec3f, noise: f32) -> f32 {
        return antumbra_visible(view, antumbra_map, antumbra_compare, position, normal); }
    fn visibility(position: vec3f, normal: vec3f, noise: f32) -> f32 {
        return antumbra_visibility(position, normal, 1.0); }";

/// How a library whose filter follows the pixel is given a lookup.
const GIVEN_PIXEL: &str = "
    fn given(case_: Case) -> AntumbraLookup {
        let pixel = antumbra_pixel(case_.view, case_.position.xyz, case_.normal.xyz);
        let spread = antumbra_spread(case_.view, case_.position.xyz, pixel);
        return AntumbraLookup(case_.look.xy, case_.look.z, case_.slope_offset.xy, spread); }";

/// Calls of a library whose filter has one.
const NOISY: &str = "
    fn given(case_: Case) -> AntumbraLookup {
        let spread = antumbra_spread(case_.view, case_.position.xyz, case_.look.w);
        return AntumbraLookup(case_.look.xy, case_.look.z, case_.slope_offset.xy, spread); }
    fn visible(view: AntumbraView, position: vec3f, normal: vec3f, noise: f32) -> f32 {
        return antumbra_visible_noisy(view, antumbra_map, antumbra_compare, position, normal, noise); }
    fn visibility(position: vec3f, normal: vec3f, noise: f32) -> f32 {
        return antumbra_visibility_noisy(position, normal, 1.0, noise); }";

/// The text of a key: the library, the cases, and calls that only some keys have.
fn text(key: WgslKey) -> String {
    let no_tap = "fn tap(look: AntumbraLookup, offset: vec2f) -> f32 { return 0.0; }";
    let tap = "fn tap(look: AntumbraLookup, offset: vec2f) -> f32 {
        return antumbra_tap(antumbra_map, antumbra_compare, look, offset); }";
    let no_row = "fn row(look: AntumbraLookup, x: vec3f, weight: vec3f, y: f32) -> f32 { return 0.0; }";
    let row = "fn row(look: AntumbraLookup, x: vec3f, weight: vec3f, y: f32) -> f32 {
        return antumbra_box_row(antumbra_map, antumbra_compare, look, x, weight, y); }";
    let row_of_four = "fn row(look: AntumbraLookup, x: vec3f, weight: vec3f, y: f32) -> f32 {
        return antumbra_box_row_of_four(antumbra_map, antumbra_compare, look, x.xyzx, weight.xyzx, y); }";
    let [tap, row] = match key.filter {
        Pcf::Point | Pcf::Hardware2x2 | Pcf::Pixel => [no_tap, no_row],
        Pcf::Box3x3 | Pcf::Disc | Pcf::Pcss => [tap, no_row],
        Pcf::Box5x5 => [tap, row],
        Pcf::Box7x7 => [tap, row_of_four],
    };
    let (given, calls) = if key.filter == Pcf::Pixel { (GIVEN_PIXEL, STEADY) } else { (GIVEN, STEADY) };
    let [given, noisy] = if key.filter.is_disc() { ["", NOISY] } else { [given, calls] };
    let looks = match key.shape {
        MapShape::Affine => {
            "fn lookup(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
                return antumbra_lookup(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH); }
            fn lit(position: vec3f, normal: vec3f) -> f32 { LIT }"
        }
        MapShape::Projective | MapShape::ProjectiveDepth => {
            "fn lookup(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
                return antumbra_lookup_projective(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH); }
            fn lit(position: vec3f, normal: vec3f) -> f32 { LIT }"
        }
    };
    let lit = if key.has_two_stages() {
        "return antumbra_lit(antumbra_place(position, normal));"
    } else {
        "return antumbra_visibility(position, normal, 1.0);"
    };
    let looks = &looks.replace("LIT", lit);
    let library = wgsl::module(key, Bindings { group: 1, first: 0 });
    [library.as_str(), include_str!("cases.wgsl"), looks, tap, row, given, noisy].join("\n")
}

/// Runs the cases on the adapter.
pub(crate) fn run(gpu: &Gpu, maps: &ShadowMaps, cases: &[Case]) -> Vec<Outcome> {
    compute(gpu, &text(maps.key()), cases, &maps.bind_entries(0))
}
