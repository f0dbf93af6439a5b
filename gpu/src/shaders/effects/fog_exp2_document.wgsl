// Exponential-squared fog as document 000 has it.

//@ at fog_factor
fog_exp2_document_factor(distance, scene_fog.density)
