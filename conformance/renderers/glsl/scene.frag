// The documents' fragment programs: 000's light and fog, 002's lightmap and cutout, 004's texture in place of the colour.
uniform sampler2D image, lightmap;
uniform vec3 plain;
uniform float alpha, cutout;
uniform vec3 fogColor;
uniform vec2 fogRange;

in vec3 eyePosition, eyeNormal;
in vec2 at, lightmapAt;
in vec4 ownColor;
INTERPOLATION in vec3 litColor;

out vec4 fragColor;

void main() {
    fragColor = vec4(plain, alpha);
#ifdef AT_VERTEX
    fragColor.rgb = litColor;
#endif
#ifdef AT_FRAGMENT
    fragColor.rgb = lit(eyePosition, normalize(eyeNormal));
#endif
#ifdef VERTEX_COLORS
    fragColor *= ownColor;
#endif
#ifdef TEXTURE_MODULATES
    fragColor *= texture(image, at);
#endif
#ifdef TEXTURE_REPLACES
    fragColor = texture(image, at);
#endif
#ifdef LIGHTMAP
    fragColor *= texture(lightmap, lightmapAt);
#endif
#ifdef CUTOUT
    if (fragColor.a < cutout) discard;
#endif
#ifdef FOG
    fragColor.rgb = mix(fogColor, fragColor.rgb, FOG);
#endif
}
