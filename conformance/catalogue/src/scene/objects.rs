//! Objects turned into draws: transforms multiplied, names resolved, what a draw needs of its mesh made sure, and the
//! order.

use super::blend::blend;
use super::camera::columns;
use super::field::{At, SceneError};
use super::material::Surface;
use glam::{DMat3, DMat4, DVec3};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::frame::{Draw, Mesh, Shading};
use lightmeter_scene::model::{Alpha, Depth, Frequency, Named, Object, Order, Scene, TransformStep};

/// Draws of a scene, at most.
const MOST_DRAWS: usize = 4096;

/// A mesh's parts among the frame's: the place of each, what it adds to the name, and its own surface.
pub(super) type Parts = Vec<(usize, String, Option<Surface>)>;

/// What objects refer to.
pub(super) struct KnownObjects<'a> {
    pub(super) scene: &'a Scene,
    /// World → eye.
    pub(super) view: DMat4,
    pub(super) surfaces: &'a [Surface],
    /// For each mesh of the scene.
    pub(super) parts: &'a [Parts],
}

/// A draw, what it is in the order, and how far away.
struct Ordered {
    draw: Draw,
    distance: f64,
}

/// The draws in their order. Meshes are given lightmap coordinates where they have but others.
pub(super) fn draws(known: &KnownObjects<'_>, meshes: &mut [Mesh]) -> Result<Vec<Draw>, SceneError> {
    let at = At::Scene.field("objects");
    let count: usize = known.scene.objects.iter().map(|object| object.instances.as_ref().map_or(1, Vec::len)).sum();
    at.require(count <= MOST_DRAWS, format_args!("a list of {count}, with instances"), "4096 at most")?;
    let mut ordered = vec![];
    for (place, object) in known.scene.objects.iter().enumerate() {
        of_object(&at.item(place), known, object, meshes, &mut ordered)?;
    }
    if known.scene.order == Order::Sorted {
        let class = |draw: &Draw| if draw.blend.is_some() { 2 } else { i32::from(draw.cutout.is_some()) };
        ordered.sort_by(|a, b| {
            let farther = b.distance.total_cmp(&a.distance);
            class(&a.draw).cmp(&class(&b.draw)).then(if a.draw.blend.is_some() {
                farther
            } else {
                std::cmp::Ordering::Equal
            })
        });
    }
    Ok(ordered.into_iter().map(|ordered| ordered.draw).collect())
}

fn of_object(
    at: &At<'_>,
    known: &KnownObjects<'_>,
    object: &Object,
    meshes: &mut [Mesh],
    draws: &mut Vec<Ordered>,
) -> Result<(), SceneError> {
    let found = known.scene.meshes.find(&object.mesh).map(|(place, _)| place);
    let parts = &known.parts[at.field("mesh").named(found, &object.mesh, &known.scene.meshes.names())?];
    let own = object.material.as_ref().map(|name| material(&at.field("material"), known, name)).transpose()?;
    let model = transform(&at.field("transform"), &object.transform)?;
    let instances = at.field("instances");
    let models = match &object.instances {
        None => vec![(String::new(), model)],
        Some(list) => {
            let placed = list.iter().enumerate();
            placed
                .map(|(k, steps)| Ok((format!("[{k}]"), transform(&instances.item(k), steps)? * model)))
                .collect::<Result<_, SceneError>>()?
        }
    };
    let name = object.name.as_ref().unwrap_or(&object.mesh);
    for (instance, model) in models {
        for (mesh, part, surface) in parts {
            let name = if parts.len() > 1 { format!("{name}{instance}/{part}") } else { format!("{name}{instance}") };
            let surface = own.or(*surface).unwrap_or(Surface::WHITE);
            let draw = of_part(at, known, object, surface, (*mesh, &mut meshes[*mesh]), name, known.view * model)?;
            let distance = (known.view * model).transform_point3(middle(&meshes[*mesh])).length();
            draws.push(Ordered { draw, distance });
        }
    }
    Ok(())
}

fn of_part(
    at: &At<'_>,
    known: &KnownObjects<'_>,
    object: &Object,
    surface: Surface,
    (place, mesh): (usize, &mut Mesh),
    name: String,
    modelview: DMat4,
) -> Result<Draw, SceneError> {
    let (shading, alpha) = shading(known.scene, object);
    let needs = |needed: bool, has: bool, what: &str| {
        let holds = format_args!("is `{}`, which has no {what}", object.mesh);
        if needed && !has { Err(at.field("mesh").refuse(holds, format_args!("a mesh with {what}"))) } else { Ok(()) }
    };
    needs(shading.is_some(), !mesh.normals.is_empty(), "normals, which its shading needs")?;
    needs(surface.texture.is_some(), !mesh.uvs.is_empty(), "texture coordinates, which its material's texture needs")?;
    needs(object.vertex_colors, !mesh.colors.is_empty(), "colours, which `vertex_colors` needs")?;
    if surface.lightmap.is_some() && mesh.lightmap_uvs.is_empty() {
        needs(true, !mesh.uvs.is_empty(), "texture coordinates, which its material's lightmap needs")?;
        mesh.lightmap_uvs.clone_from(&mesh.uvs);
    }
    if shading.is_some() && is_flat(DMat3::from_mat4(modelview)) {
        let holds = "makes the object flat, and its normals have no direction then";
        return Err(at.field("transform").refuse(holds, "scales that are not 0, or `unlit`"));
    }
    let blended = object.blend.as_ref().map(|state| blend(&at.field("blend"), state)).transpose()?;
    Ok(Draw {
        name,
        mesh: place,
        modelview: columns(&at.field("transform"), modelview)?,
        material: surface.material,
        shading,
        alpha: if alpha == Alpha::One { 1.0 } else { surface.opacity },
        vertex_colors: object.vertex_colors,
        texture: surface.texture,
        lightmap: surface.lightmap,
        cutout: object.cutout.map(|threshold| at.field("cutout").share(threshold)).transpose()?,
        blend: blended,
        depth: depth(known.scene, object),
        cull: object.cull,
    })
}

fn material(at: &At<'_>, known: &KnownObjects<'_>, name: &str) -> Result<Surface, SceneError> {
    let found = known.scene.materials.find(name).map(|(place, _)| known.surfaces[place]);
    at.named(found, name, &known.scene.materials.names())
}

/// The object's choices over the scene's over the defaults.
fn shading(scene: &Scene, object: &Object) -> (Option<Shading>, Alpha) {
    let (own, all) = (object.shading, scene.shading);
    let frequency = match own.frequency.or(all.frequency).unwrap_or_default() {
        Frequency::Unlit => None,
        Frequency::Flat => Some(lightmeter_scene::shading::Frequency::Flat),
        Frequency::Gouraud => Some(lightmeter_scene::shading::Frequency::Gouraud),
        Frequency::Phong => Some(lightmeter_scene::shading::Frequency::Phong),
    };
    let shading = frequency.map(|frequency| Shading {
        frequency,
        provoking: own.provoking.or(all.provoking).unwrap_or_default(),
        specular: own.specular.or(all.specular).unwrap_or_default(),
        gate: own.gate.or(all.gate).unwrap_or_default(),
        viewer: own.viewer.or(all.viewer).unwrap_or_default(),
        normals: own.normals.or(all.normals).unwrap_or_default(),
    });
    (shading, own.alpha.or(all.alpha).unwrap_or_default())
}

fn depth(scene: &Scene, object: &Object) -> Option<DepthTest> {
    let compare = match (object.blend.is_some(), scene.camera.reversed_depth) {
        (false, false) => Compare::Less,
        (true, false) => Compare::LessEqual,
        (false, true) => Compare::Greater,
        (true, true) => Compare::GreaterEqual,
    };
    match object.depth {
        None => Some(DepthTest { compare, write: object.blend.is_none() }),
        Some(Depth::None) => None,
        Some(Depth::Test(test)) => Some(DepthTest { compare: test.compare, write: test.write }),
    }
}

/// Object → world.
pub(super) fn transform(at: &At<'_>, steps: &[TransformStep]) -> Result<DMat4, SceneError> {
    let mut matrix = DMat4::IDENTITY;
    for (place, step) in steps.iter().enumerate() {
        let at = at.item(place);
        let next = match *step {
            TransformStep::Translate(by) => {
                at.field("translate").numbers(by)?;
                DMat4::from_translation(by.into())
            }
            TransformStep::Rotate { deg, axis } => {
                let at = at.field("rotate");
                at.field("deg").number(deg)?;
                at.field("axis").direction(axis)?;
                let Some(axis) = DVec3::from(axis).try_normalize() else {
                    return Err(at.field("axis").refuse("is too short", "a vector that is not 0"));
                };
                DMat4::from_axis_angle(axis, deg.to_radians())
            }
            TransformStep::Scale(by) => {
                at.field("scale").numbers(by)?;
                DMat4::from_scale(by.into())
            }
            TransformStep::Matrix(columns) => {
                let at = at.field("matrix");
                for (place, column) in columns.iter().enumerate() {
                    at.item(place).numbers(*column)?;
                }
                let matrix = DMat4::from_cols_array_2d(&columns);
                let affine = matrix.row(3) == DMat4::IDENTITY.row(3);
                at.require(affine, format_args!("a matrix with the last row {}", matrix.row(3)), "[0, 0, 0, 1] there")?;
                matrix
            }
        };
        matrix = next * matrix;
    }
    Ok(matrix)
}

/// Whether the matrix maps space to a plane or less, to some nine digits.
fn is_flat(matrix: DMat3) -> bool {
    let box_of = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    let volume = matrix.determinant().abs();
    volume.is_nan() || volume <= 1e-9 * box_of
}

/// The middle of the mesh's box.
fn middle(mesh: &Mesh) -> DVec3 {
    let points = || mesh.positions.iter().map(|position| DVec3::from(position.map(f64::from)));
    let low = points().fold(DVec3::INFINITY, DVec3::min);
    let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
    (low + high) / 2.0
}

/// The matrix to eye space of what a light is attached to.
pub(super) fn space(at: &At<'_>, scene: &Scene, view: DMat4, attached: &str) -> Result<DMat4, SceneError> {
    match attached {
        "world" => return Ok(view),
        "camera" => return Ok(DMat4::IDENTITY),
        _ => {}
    }
    let named = |object: &Object| object.name.as_deref().unwrap_or(&object.mesh) == attached;
    let mut found = scene.objects.iter().enumerate().filter(|(_, object)| named(object));
    let (Some((place, object)), None) = (found.next(), found.next()) else {
        let names: Vec<&str> = scene.objects.iter().filter_map(|object| object.name.as_deref()).collect();
        let allowed = format!(
            "world, camera or the name of one object{}{}",
            if names.is_empty() { "" } else { ": " },
            names.join(", ")
        );
        return Err(at.refuse(format_args!("is `{attached}`"), allowed));
    };
    if object.instances.is_some() {
        return Err(at.refuse(format_args!("is `{attached}`, which has instances"), "an object without instances"));
    }
    let objects = At::Scene.field("objects");
    Ok(view * transform(&objects.item(place).field("transform"), &object.transform)?)
}

/// Refuses objects named as the spaces are.
pub(super) fn names(scene: &Scene) -> Result<(), SceneError> {
    let at = At::Scene.field("objects");
    for (place, object) in scene.objects.iter().enumerate() {
        if let Some(name @ ("world" | "camera")) = object.name.as_deref() {
            return Err(at
                .item(place)
                .field("name")
                .refuse(format_args!("is `{name}`"), "another name: lights are attached to that"));
        }
    }
    Ok(())
}

/// The images that materials read are there.
pub(super) fn surfaces(scene: &Scene) -> Result<Vec<Surface>, SceneError> {
    let at = At::Scene.field("materials");
    let each: &Named<_> = &scene.materials;
    each.iter().map(|(name, material)| super::material::surface(&at.field(name), material, &scene.textures)).collect()
}
