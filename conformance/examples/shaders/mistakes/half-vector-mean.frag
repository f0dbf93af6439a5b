// lighting/blinn, whose half vector is the mean of two unit vectors and is not normalised.
precision mediump float;

varying vec3 vNormal;
varying vec3 vPosition;
uniform vec3 uAmbient;
uniform vec3 uDiffuse;
uniform vec3 uSpecular;
uniform vec3 uLightDir;
uniform float uShininess;

void main() {
    vec3 n = normalize(vNormal);
    vec3 l = normalize(uLightDir);
    vec3 v = normalize(-vPosition);
    vec3 h = (l + v) * 0.5;
    vec3 color = uAmbient + uDiffuse * max(dot(n, l), 0.0) + uSpecular * pow(max(dot(n, h), 0.0), uShininess);
    gl_FragColor = vec4(color, 1.0);
}
