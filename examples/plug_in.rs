//! The smallest engine with shadows: a few boxes and a ball in the sun, drawn to `target/plug_in.png`.
//!
//! `cargo run --example plug_in`. Read it from top to bottom; what concerns shadows is numbered 1 to 6. The engine
//! keeps its own device, vertex format, pipelines, passes and reversed-depth camera.

use std::error::Error;
use std::f32::consts::{PI, TAU};
use std::ops::Range;

use antumbra::gpu::{self, ShadowMaps, ShadowMapsDescriptor, wgpu};
use antumbra::{
    Aabb, Camera, ClipDepth, FitInput, Light, MapBudget, Object, Scene, ShadowFrame, ShadowTechnique, techniques, wgsl,
};
use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, DVec4, Mat4, UVec2, Vec3, Vec4};

const SIZE: UVec2 = UVec2::new(1280, 720);

fn main() -> Result<(), Box<dyn Error>> {
    let engine = Engine::new()?;
    let world = World::new(&engine.device);

    // 1. Choose a technique and the texels it may use, and make its maps.
    let technique = techniques::fsm();
    let map = MapBudget::one(2048);
    let key = technique.wgsl_key();
    let maps = ShadowMaps::new(&engine.device, &ShadowMapsDescriptor { label: Some("sun"), key, map })?;

    // 2. Paste the library's text in front of the engine's shader; here its bindings are group 1, from 0 on.
    let library = wgsl::module(key, wgsl::Bindings { group: 1, first: 0 });
    let shade = engine.shade_pipeline(&(library + include_str!("plug_in.wgsl")), maps.bind_group_layout());
    let caster_text = wgsl::CASTER.to_owned() + include_str!("plug_in_caster.wgsl");
    let cast = engine.caster_pipeline(&caster_text, maps.caster_layout());

    // 3. Each frame: fit. The library reads the engine's own matrices; reversed depth and infinite far are recognised.
    let world_from_view = Camera::look_at(DVec3::new(5.5, 4.0, 9.0), DVec3::new(0.2, 0.7, 0.0), DVec3::Y);
    let clip_from_view = reversed_infinite(0.7, f64::from(SIZE.x) / f64::from(SIZE.y), 0.05);
    let mut camera = Camera::from_matrices(world_from_view, clip_from_view, ClipDepth::ZeroToOne)?;
    camera.viewport = SIZE;
    let travel = DVec3::new(0.8, -0.9, -0.35).normalize();
    let light = Light::Directional { travel };
    let scene = Scene { objects: &world.objects, ..Scene::within(world.bounds()) };
    let frame = technique.fit(&FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None })?;
    for cut in &frame.left_out {
        println!("left out: {cut}");
    }

    // 4. Upload it.
    maps.prepare(&engine.queue, &frame)?;
    let uniforms = EngineUniforms {
        clip_from_world: (clip_from_view * world_from_view.inverse()).as_mat4(),
        to_sun: (-travel).as_vec3().extend(0.0),
    };
    engine.queue.write_buffer(&engine.uniforms, 0, bytemuck::bytes_of(&uniforms));

    // 5. Draw casters, then the picture; submit.
    let mut encoder = engine.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    draw_casters(&mut encoder, &maps, &frame, &cast, &world);
    engine.draw(&mut encoder, &shade, &maps, &world);
    engine.queue.submit([encoder.finish()]);
    std::fs::create_dir_all("target")?;
    engine.save("target/plug_in.png")?;
    println!("target/plug_in.png: {} triangles, {} KiB of shadow map", world.vertices / 3, maps.bytes() / 1024);
    Ok(())
}

/// 6. The caster pass: the library begins it, the engine draws what may throw a shadow into the view.
fn draw_casters(
    encoder: &mut wgpu::CommandEncoder,
    maps: &ShadowMaps,
    frame: &ShadowFrame,
    pipeline: &wgpu::RenderPipeline,
    world: &World,
) {
    for (index, view) in frame.views.iter().enumerate() {
        let mut pass = maps.caster_pass(encoder, view, None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, maps.caster_bind_group(), &[maps.caster_offset(index)]);
        pass.set_vertex_buffer(0, world.buffer.slice(..));
        for (object, vertices) in world.objects.iter().zip(&world.ranges) {
            if object.casts && view.cull.may_cast(&object.bounds) {
                pass.draw(vertices.clone(), 0..1);
            }
        }
    }
}

// ---- From here on: an engine like any other. ----

/// The engine's projection: symmetric, depth 1 at the near plane and 0 at infinity.
fn reversed_infinite(fov_y: f64, aspect: f64, near: f64) -> DMat4 {
    let focal = 1.0 / (0.5 * fov_y).tan();
    DMat4::from_cols(
        DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, focal, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 0.0, -1.0),
        DVec4::new(0.0, 0.0, near, 0.0),
    )
}

/// What `plug_in.wgsl` calls `Engine`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct EngineUniforms {
    clip_from_world: Mat4,
    to_sun: Vec4,
}

/// The engine's vertex format.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Vertex {
    position: Vec3,
    normal: Vec3,
    colour: Vec3,
}

/// What there is to draw.
struct World {
    buffer: wgpu::Buffer,
    vertices: u32,
    objects: Vec<Object>,
    ranges: Vec<Range<u32>>,
}

impl World {
    fn new(device: &wgpu::Device) -> Self {
        let (grey, red, blue) = (Vec3::new(0.62, 0.60, 0.56), Vec3::new(0.75, 0.25, 0.18), Vec3::new(0.2, 0.35, 0.7));
        let white = Vec3::splat(0.85);
        let meshes = [
            cuboid(Vec3::new(0.0, -0.05, 0.0), Vec3::new(14.0, 0.05, 14.0), grey),
            cuboid(Vec3::new(-2.2, 1.0, 0.4), Vec3::new(0.5, 1.0, 0.5), red),
            cuboid(Vec3::new(0.2, 0.35, 2.2), Vec3::new(0.9, 0.35, 0.35), blue),
            cuboid(Vec3::new(-1.0, 1.9, -2.6), Vec3::new(0.08, 1.9, 0.08), white),
            cuboid(Vec3::new(1.2, 1.6, -1.6), Vec3::new(1.1, 0.06, 0.5), white),
            ball(Vec3::new(1.6, 0.8, 0.6), 0.8, white),
        ];
        let (mut all, mut objects, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for mesh in meshes {
            let first = all.len() as u32;
            let bounds = Aabb::around(mesh.iter().map(|vertex| vertex.position.as_dvec3()));
            objects.push(Object { bounds, casts: true });
            all.extend(mesh);
            ranges.push(first..all.len() as u32);
        }
        let contents: &[u8] = bytemuck::cast_slice(&all);
        let usage = wgpu::BufferUsages::VERTEX;
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some("world"), contents, usage };
        let buffer = wgpu::util::DeviceExt::create_buffer_init(device, &descriptor);
        Self { buffer, vertices: all.len() as u32, objects, ranges }
    }

    fn bounds(&self) -> Aabb {
        self.objects.iter().fold(Aabb::EMPTY, |bounds, object| bounds.union(object.bounds))
    }
}

fn cuboid(centre: Vec3, half: Vec3, colour: Vec3) -> Vec<Vertex> {
    let mut mesh = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let along = |slot: usize| Vec3::AXES[(axis + slot) % 3];
            let (normal, right, up) = (along(0) * sign, along(1), along(2) * sign);
            let corner =
                |x: f32, y: f32| Vertex { position: centre + (normal + right * x + up * y) * half, normal, colour };
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            mesh.extend([a, b, c, a, c, d]);
        }
    }
    mesh
}

fn ball(centre: Vec3, radius: f32, colour: Vec3) -> Vec<Vertex> {
    let (rings, sectors) = (96_u16, 192_u16);
    let vertex = |ring: u16, sector: u16| {
        let (down, round) = (PI * f32::from(ring) / f32::from(rings), TAU * f32::from(sector) / f32::from(sectors));
        let normal = Vec3::new(down.sin() * round.cos(), down.cos(), -down.sin() * round.sin());
        Vertex { position: centre + normal * radius, normal, colour }
    };
    let mut mesh = Vec::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let [a, b] = [vertex(ring, sector), vertex(ring, sector + 1)];
            let [c, d] = [vertex(ring + 1, sector + 1), vertex(ring + 1, sector)];
            mesh.extend([a, d, c, a, c, b]);
        }
    }
    mesh
}

/// Device, targets, and what the engine's shader reads.
struct Engine {
    device: wgpu::Device,
    queue: wgpu::Queue,
    picture: wgpu::Texture,
    depth: wgpu::Texture,
    uniforms: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
}

/// The picture's format.
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

impl Engine {
    fn new() -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        println!("adapter: {}", adapter.get_info().name);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        let target = |format| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("target"),
                size: wgpu::Extent3d { width: SIZE.x, height: SIZE.y, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let (picture, depth) = (target(COLOUR), target(wgpu::TextureFormat::Depth32Float));
        let uniforms = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("engine"),
            size: size_of::<EngineUniforms>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("engine"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let entries = [wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }];
        let descriptor = wgpu::BindGroupDescriptor { label: Some("engine"), layout: &layout, entries: &entries };
        let group = device.create_bind_group(&descriptor);
        Ok(Self { device, queue, picture, depth, uniforms, layout, group })
    }

    /// Casters: positions alone, no fragment shader, the library's depth state.
    fn caster_pipeline(&self, text: &str, casters: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
        self.pipeline(text, "cast_shadow", None, &[Some(casters)], gpu::depth_stencil_state())
    }

    /// The picture: the engine's group 0, the shadow maps' group 1, reversed depth.
    fn shade_pipeline(&self, text: &str, maps: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
        let reversed = wgpu::DepthStencilState {
            depth_compare: Some(wgpu::CompareFunction::Greater),
            ..gpu::depth_stencil_state()
        };
        self.pipeline(text, "place", Some("shade"), &[Some(&self.layout), Some(maps)], reversed)
    }

    fn pipeline(
        &self,
        text: &str,
        vertex: &str,
        fragment: Option<&str>,
        groups: &[Option<&wgpu::BindGroupLayout>],
        depth: wgpu::DepthStencilState,
    ) -> wgpu::RenderPipeline {
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = &self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(vertex), source });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(vertex),
            bind_group_layouts: groups,
            immediate_size: 0,
        });
        let vertices = wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3],
        };
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        let targets = [Some(COLOUR.into())];
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(vertex),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(vertex),
                compilation_options: compilation_options.clone(),
                buffers: &[Some(vertices)],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(depth),
            multisample: wgpu::MultisampleState::default(),
            fragment: fragment.map(|entry_point| wgpu::FragmentState {
                module,
                entry_point: Some(entry_point),
                compilation_options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        maps: &ShadowMaps,
        world: &World,
    ) {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let sky = wgpu::Color { r: 0.42, g: 0.58, b: 0.78, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(&self.picture),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(sky), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view(&self.depth),
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_bind_group(1, maps.bind_group(), &[]);
        pass.set_vertex_buffer(0, world.buffer.slice(..));
        pass.draw(0..world.vertices, 0..1);
    }

    fn save(&self, path: &str) -> Result<(), Box<dyn Error>> {
        // 1280 pixels of 4 bytes are a multiple of the 256 bytes that rows have to be.
        let row = SIZE.x * 4;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(row * SIZE.y),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.picture.as_image_copy(), target, self.picture.size());
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        image::save_buffer(path, &buffer.get_mapped_range(..)?, SIZE.x, SIZE.y, image::ColorType::Rgba8)?;
        Ok(())
    }
}
