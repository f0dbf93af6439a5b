//! The tables: mistakes that pixels show, mistakes that they do not, and scenes drawn rightly.

/// A mistake: the file, what stands there, what is put in its place, the scene that shows it, and where that departs.
pub(super) type Mistake = (&'static str, &'static str, &'static str, &'static str, &'static str, &'static str);

/// Mistakes that pixels show.
pub(super) const MISTAKES: &[Mistake] = &[
    // Where things are. The wrong surface in front is at another position: there a wrong depth departs first.
    (
        "positions + 0.2 %",
        "scene.wgsl",
        "vec4f(in.position, 1.0)",
        "vec4f(1.002 * in.position, 1.0)",
        "color-cube",
        "position",
    ),
    (
        "depth the wrong way round",
        "scene.wgsl",
        "out.clip = scene_draw.projection * eye;",
        "out.clip = scene_draw.projection * eye; out.clip.z = out.clip.w - out.clip.z;",
        "depth-on-off",
        "position",
    ),
    ("what is opaque cut out", "effects/cutout.wgsl", "color.a <", "color.a >=", "sorted", "position"),
    // Normals.
    (
        "normals by the modelview",
        "effects/inverse_transpose.wgsl",
        "vector_normal_inverse_transpose(",
        "vector_normal_modelview(",
        "scaled-normals",
        "normal",
    ),
    (
        "the inverse transpose for the modelview",
        "scene.wgsl",
        "vector_normal_modelview(",
        "vector_normal_inverse_transpose(",
        "scaled-normals",
        "normal",
    ),
    (
        "normals not normalised again",
        "effects/phong.wgsl",
        "vector_normalize(in.normal)",
        "in.normal",
        "phong",
        "normal",
    ),
    ("normals not normalised", "scene.wgsl", "vector_normalize(brought)", "brought", "scaled-normals", "normal"),
    // Constant and diffuse terms.
    ("emission left out", "effects/emissive.wgsl", "sum += scene_material.emissive;", "", "obj", "diffuse"),
    (
        "ambient left out",
        "effects/ambient_product.wgsl",
        "sum += lighting_ambient(scene_ambient.color, scene_material.ambient);",
        "",
        "phong",
        "diffuse",
    ),
    (
        "no incidence",
        "effects/diffuse.wgsl",
        "scene_material.diffuse * incidence",
        "scene_material.diffuse",
        "phong",
        "diffuse",
    ),
    // Known to be wrong: the shader of the intermediate result has no highlights, and so passes lights behind the
    // surface over, which hides the mistake. It is one of `diffuse`.
    ("incidence not clamped", "lighting.wgsl", "return max(dot(l, n), 0.0);", "return dot(l, n);", "phong", "surface"),
    ("kl and kq swapped", "attenuation.wgsl", "d * (kl + d * kq)", "d * (kq + d * kl)", "eight-lights", "diffuse"),
    (
        "a light too few",
        "effects/point.wgsl",
        "i < scene_point.count",
        "i + 1u < scene_point.count",
        "eight-lights",
        "diffuse",
    ),
    (
        "a position taken for a direction",
        "effects/point.wgsl",
        "vector_toward(position, p)",
        "vector_normalize(position)",
        "phong",
        "diffuse",
    ),
    (
        "a direction not normalised",
        "effects/directional.wgsl",
        "vector_normalize(scene_directional.lights[i].toward)",
        "scene_directional.lights[i].toward",
        "flat",
        "diffuse",
    ),
    (
        "cutoff + 1 %",
        "effects/spot.wgsl",
        "= scene_spot.lights[i].cutoff_cosine;",
        "= cos(1.01 * acos(scene_spot.lights[i].cutoff_cosine));",
        "spotlight",
        "diffuse",
    ),
    (
        "the cone's exponent + 1 %",
        "effects/spot_exponent.wgsl",
        "scene_spot.lights[i].exponent",
        "1.01 * scene_spot.lights[i].exponent",
        "spotlight",
        "diffuse",
    ),
    ("smooth for flat", "effects/flat.wgsl", "@interpolate(flat, first) ", "", "flat", "diffuse"),
    // Highlights.
    ("reflect with its sign flipped", "vector.wgsl", "return i - 2.0", "return i + 2.0", "phong", "specular"),
    ("v + l not normalised", "vector.wgsl", "vector_normalize(v + l)", "(v + l)", "phong-blinn", "specular"),
    (
        "v + l normalised where it is not to be",
        "vector.wgsl",
        "return v + l;",
        "return vector_normalize(v + l);",
        "phong-blinn",
        "specular",
    ),
    (
        "shininess + 1 %",
        "effects/specular_phong.wgsl",
        "scene_material.shininess",
        "1.01 * scene_material.shininess",
        "shininess",
        "specular",
    ),
    (
        "a viewer that is not local",
        "effects/local_viewer.wgsl",
        "vector_normalize(-p)",
        "vec3f(0.0, 0.0, 1.0)",
        "viewer",
        "specular",
    ),
    (
        "highlights not attenuated",
        "scene_lighting.wgsl",
        "* gated\n        //@ when weighted\n        * weight\n        //@ end\n",
        "* gated\n",
        "eight-lights",
        "specular",
    ),
    // The surface.
    (
        "red for blue",
        "effects/vertex_color.wgsl",
        "color_modulate(in.color,",
        "color_modulate(in.color.bgra,",
        "color-cube",
        "surface",
    ),
    (
        "a texture upside down",
        "texture.wgsl",
        "floor(uv * vec2f(textureDimensions(image)))",
        "floor(vec2f(uv.x, 1.0 - uv.y) * vec2f(textureDimensions(image)))",
        "lightmap",
        "surface",
    ),
    (
        "half a texel off",
        "texture.wgsl",
        "vec2f(textureDimensions(image)) - 0.5",
        "vec2f(textureDimensions(image))",
        "lightmap",
        "surface",
    ),
    (
        "a lightmap that adds",
        "scene.wgsl",
        "color_modulate(lightmap_texel, color)",
        "lightmap_texel + color",
        "lightmap",
        "surface",
    ),
    ("alpha dropped", "scene.wgsl", "scene_draw.alpha,\n    );", "1.0,\n    );", "translucent-square", "surface"),
    (
        "encoded by a gamma",
        "scene.wgsl",
        "    return color;\n    //@ end\n}",
        "    return vec4f(pow(color.rgb, vec3f(1.0 / 2.2)), color.a);\n    //@ end\n}",
        "lightmap",
        "surface",
    ),
    (
        "texture coordinates linear for perspective",
        "scene.wgsl",
        concat!(
            "    //@ when fragment_normal\n    @location(1) normal: vec3f,\n",
            "    //@ end\n    //@ when texture\n    @location(2) uv"
        ),
        concat!(
            "    //@ when fragment_normal\n    @location(1) normal: vec3f,\n",
            "    //@ end\n    //@ when texture\n    @location(2) @interpolate(linear) uv"
        ),
        "near-clip",
        "surface",
    ),
    (
        "a texture not repeated",
        "texture.wgsl",
        "select(repeated, clamp(i, 0, size - 1), clamps)",
        "clamp(i, 0, size - 1)",
        "teapot",
        "surface",
    ),
    // Fog.
    ("alpha lost in the fog", "scene.wgsl", "color.rgb).color, color.a)", "color.rgb).color, 0.5)", "fog-exp", "fog"),
    // Known to be wrong: what fog hides is black in the reference's intermediate results, and lit in the device's. The
    // mistake is one of `fog`.
    (
        "planar for radial",
        "effects/fog_radial.wgsl",
        "fog_radial_distance(p)",
        "fog_planar_distance(p)",
        "fog-radial",
        "diffuse",
    ),
    ("radial for planar", "fog.wgsl", "return abs(p.z);", "return length(p);", "fog-linear", "fog"),
    (
        "exponential-squared fog as document 000 has it",
        "effects/fog_exp2_opengl.wgsl",
        "fog_exp2_opengl_factor(",
        "fog_exp2_document_factor(",
        "fog-exp2-opengl",
        "fog",
    ),
    ("density + 1 %", "effects/fog_exp.wgsl", "scene_fog.density", "1.01 * scene_fog.density", "fog-exp", "fog"),
    ("mixed the wrong way round", "fog.wgsl", "mix(fog, shaded, f)", "mix(shaded, fog, f)", "fog-exp", "fog"),
];

/// Mistakes that are too small for 8 bits, or that change no winner of a depth test: every pixel is legal, and rightly
/// so. The intermediate results show them all the same.
pub(super) const UNSEEN: &[Mistake] = &[
    (
        "positions + 0.01 %, less than a subpixel",
        "scene.wgsl",
        "vec4f(in.position, 1.0)",
        "vec4f(1.0001 * in.position, 1.0)",
        "phong",
        "position",
    ),
    (
        "all depths alike too small",
        "scene.wgsl",
        "out.clip = scene_draw.projection * eye;",
        "out.clip = scene_draw.projection * eye; out.clip.z *= 0.999;",
        "depth-on-off",
        "depth",
    ),
    (
        "normals linear for perspective, on small triangles",
        "scene.wgsl",
        "    //@ when fragment_normal\n    @location(1) normal",
        "    //@ when fragment_normal\n    @location(1) @interpolate(linear) normal",
        "phong",
        "normal",
    ),
    (
        "a lit colour linear for perspective, on small triangles",
        "effects/gouraud.wgsl",
        "@location(5) smooth_lit",
        "@location(5) @interpolate(linear) smooth_lit",
        "gouraud",
        "diffuse",
    ),
    (
        "shininess + 1 %, in 8 bits",
        "effects/specular_blinn.wgsl",
        "scene_material.shininess",
        "1.01 * scene_material.shininess",
        "teapot",
        "specular",
    ),
];

/// Scenes, and where the built-in shaders are said to depart.
pub(super) const RIGHT: &[(&str, &str)] = &[
    ("color-cube", "store"),
    ("depth-on-off", "store"),
    ("eight-lights", "store"),
    ("flat", "store"),
    ("fog-exp", "store"),
    ("lightmap", "blend"),
    ("missed-highlight", "store"),
    ("phong", "store"),
    ("phong-blinn", "store"),
    ("scaled-normals", "store"),
    ("sorted", "blend"),
    ("spotlight", "store"),
    ("teapot", "store"),
    ("translucent-square", "blend"),
    ("viewer", "store"),
    // Known to be wrong: what fog hides is black in the reference's intermediate results, and lit in the device's.
    ("fog-linear", "diffuse"),
    ("fog-radial", "diffuse"),
    // Known to be wrong: highlights of 1e-36, whose gradients a rasteriser flushes, which the bound does not count.
    ("gouraud", "specular"),
];
