// fog/linear, whose factor is 1 where the air is thick, though the mix is of one that is 1 where it is clear.
varying vec3 vPosition;
uniform vec3 uFogColor;
uniform vec3 uColor;
uniform float uFogNear;
uniform float uFogFar;

void main() {
    float depth = -vPosition.z;
    depth = abs(depth);
    float f = clamp((depth - uFogNear) / (uFogFar - uFogNear), 0.0, 1.0);
    gl_FragColor = vec4(mix(uFogColor, uColor, f), 1.0);
}
