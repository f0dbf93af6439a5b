// Exponential fog.

//@ at fog_factor
fog_exp_factor(distance, scene_fog.density)
