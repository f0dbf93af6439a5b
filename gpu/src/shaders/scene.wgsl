// A draw of a scene, vertex to fragment: where effects put their text. `compose.rs` says how lines with an at sign are
// read. p is the point in eye space, n its normal, f the fog's factor.

//@ let specular = specular_phong | specular_blinn | specular_unnormalised
//@ let constant = emissive | ambient_product | ambient_constant
//@ let lights = directional | directional_unit | point | spot
//@ let normals = diffuse | specular | stage_normal & has_normals
//@ let texture = texture_nearest | texture_bilinear
//@ let lightmap = lightmap_nearest | lightmap_bilinear
//@ let fog = fog_linear | fog_exp | fog_exp2_document | fog_exp2_opengl
//@ let weight_used = diffuse | specular | attenuated_ambient
//@ let weighted = weight_used & (attenuation | spot)
//@ let vectors_in = toward_1 | vectors_interpolated & specular & local_viewer
//@ let place_used = local_viewer | weight_used & spot | (diffuse | specular | attenuation) & point
//@ let lit_position = place_used & !vectors_interpolated | attenuation & vectors_interpolated
//@ let fragment_position = fog & !fog_at_vertex | stage_position | phong & lit_position
//@ let fragment_normal = stage_normal & has_normals | phong & normals
//@ let lit_in = flat | gouraud | phong & (lit_position | normals | fog)
//@ let colored_in = surface & (texture | lightmap | vertex_color) | fog | stage_normal & has_normals
//@ let fragment_in = lit_in | colored_in | stage_position | stage_depth
//@ let before_surface = stage_position | stage_depth | stage_normal | stage_diffuse | stage_specular
//@ let surface = cutout | !before_surface

struct SceneVertex {
    @location(0) position: vec3f,
    //@ when normals
    @location(1) normal: vec3f,
    //@ end
    //@ when texture
    @location(2) uv: vec2f,
    //@ end
    //@ when lightmap
    @location(3) lightmap_uv: vec2f,
    //@ end
    //@ members vertex
}

struct SceneVaryings {
    @invariant @builtin(position) clip: vec4f,
    //@ when fragment_position
    @location(0) p: vec3f,
    //@ end
    //@ when fragment_normal
    @location(1) normal: vec3f,
    //@ end
    //@ when texture
    @location(2) uv: vec2f,
    //@ end
    //@ when lightmap
    @location(3) lightmap_uv: vec2f,
    //@ end
    //@ when fog & fog_at_vertex
    @location(7) fog_factor: f32,
    //@ end
    //@ when vectors_interpolated & specular & local_viewer
    @location(8) viewer: vec3f,
    //@ end
    //@ when toward_1
    @location(9) toward_1: vec3f,
    //@ end
    //@ when toward_2
    @location(10) toward_2: vec3f,
    //@ end
    //@ when toward_3
    @location(11) toward_3: vec3f,
    //@ end
    //@ when toward_4
    @location(12) toward_4: vec3f,
    //@ end
    //@ members varyings
}

@vertex
fn scene_vertex(in: SceneVertex) -> SceneVaryings {
    var out: SceneVaryings;
    let eye = scene_draw.modelview * vec4f(in.position, 1.0);
    out.clip = scene_draw.projection * eye;
    //@ when fragment_position
    out.p = eye.xyz;
    //@ end
    //@ when normals
    let upper = mat3x3f(scene_draw.modelview[0].xyz, scene_draw.modelview[1].xyz, scene_draw.modelview[2].xyz);
    //@ choose brought: vec3f from eye_normal else vector_normal_modelview(upper, in.normal)
    let n = vector_normalize(brought);
    //@ end
    //@ when fragment_normal
    out.normal = n;
    //@ end
    //@ when texture
    out.uv = in.uv;
    //@ end
    //@ when lightmap
    out.lightmap_uv = in.lightmap_uv;
    //@ end
    //@ if !stage_normal & (flat | gouraud)
    let lit = scene_lit(
        //@ when lit_position
        eye.xyz,
        //@ end
        //@ when normals
        n,
        //@ end
    );
    //@ slot vertex_lit
    //@ end
    //@ when fog & fog_at_vertex
    out.fog_factor = scene_fog_factor(eye.xyz);
    //@ end
    //@ when vectors_interpolated & specular & local_viewer & !unit_vectors
    out.viewer = -eye.xyz;
    //@ end
    //@ when vectors_interpolated & specular & local_viewer & unit_vectors
    out.viewer = vector_normalize(-eye.xyz);
    //@ end
    //@ when toward_1
    out.toward_1 = scene_toward_at_vertex(0u, eye.xyz);
    //@ end
    //@ when toward_2
    out.toward_2 = scene_toward_at_vertex(1u, eye.xyz);
    //@ end
    //@ when toward_3
    out.toward_3 = scene_toward_at_vertex(2u, eye.xyz);
    //@ end
    //@ when toward_4
    out.toward_4 = scene_toward_at_vertex(3u, eye.xyz);
    //@ end
    //@ slot vertex_out
    return out;
}

// The lit colour of a fragment.
fn scene_shaded(
    //@ when lit_in
    in: SceneVaryings,
    //@ end
    //@ when fog & phong
    f: f32,
    //@ end
) -> vec3f {
    //@ choose rgb: vec3f from lit else scene_constant()
    return rgb;
}

fn scene_fog_factor(p: vec3f) -> f32 {
    //@ choose distance: f32 from fog_distance else fog_planar_distance(p)
    //@ choose f: f32 from fog_factor else 1.0
    return f;
}

@fragment
fn scene_fragment(
    //@ when fragment_in
    in: SceneVaryings,
    //@ end
) -> @location(0) vec4f {
    //@ when fog & !fog_at_vertex
    let f = scene_fog_factor(in.p);
    //@ end
    //@ when fog & fog_at_vertex
    let f = clamp(in.fog_factor, 0.0, 1.0);
    //@ end
    //@ when surface
    //@ when before_surface
    var color = vec4f(0.0, 0.0, 0.0, scene_draw.alpha);
    //@ end
    //@ when !before_surface
    var color: vec4f;
    //@ end
    //@ if !before_surface & !texture_replace
    color = vec4f(
        scene_shaded(
            //@ when lit_in
            in,
            //@ end
            //@ when fog & phong
            f,
            //@ end
        ),
        scene_draw.alpha,
    );
    //@ end
    //@ slot surface
    //@ if texture
    //@ choose texel: vec4f from texel else vec4f(1.0)
    //@ choose textured: vec4f from textured else color_modulate(texel, color)
    color = textured;
    //@ end
    //@ if lightmap
    //@ choose lightmap_texel: vec4f from lightmap_texel else vec4f(1.0)
    color = color_modulate(lightmap_texel, color);
    //@ end
    //@ slot cutout
    //@ end
    //@ if fog
    color = vec4f(fog_mix(f, scene_fog.color, color.rgb).color, color.a);
    //@ end
    //@ when stage_position
    return vec4f(in.p, 1.0);
    //@ end
    //@ when stage_depth
    return vec4f(in.clip.z, 0.0, 0.0, 1.0);
    //@ end
    //@ when stage_normal & has_normals
    //@ choose n: vec3f from fragment_normal else in.normal
    return vec4f(n, 1.0);
    //@ end
    //@ when stage_normal & !has_normals
    return vec4f(0.0, 0.0, 0.0, 1.0);
    //@ end
    //@ when stage_diffuse | stage_specular
    let rgb = scene_shaded(
        //@ when lit_in
        in,
        //@ end
    );
    return vec4f(rgb, 1.0);
    //@ end
    //@ when !before_surface
    return color;
    //@ end
}
