// Linear fog as lecture slides have it.
// lightmeter run fog/linear --shader slides-fog.frag
#version 330

in vec3 Position;

struct FogInfo { float maxDist; float minDist; vec3 color; };
uniform FogInfo Fog;
uniform vec3 shadeColor;

out vec4 FragColor;

void main()
{
    float dist = abs(Position.z);
    float fogFactor = clamp((Fog.maxDist - dist) / (Fog.maxDist - Fog.minDist), 0.0, 1.0);
    FragColor = vec4(mix(Fog.color, shadeColor, fogFactor), 1.0);
}
