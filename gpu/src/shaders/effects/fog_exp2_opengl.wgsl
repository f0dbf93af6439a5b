// Exponential-squared fog as OpenGL has it.

//@ at fog_factor
fog_exp2_opengl_factor(distance, scene_fog.density)
