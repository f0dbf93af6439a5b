export const EFFECTS=[]; export function drawScene(){ return {skip:"not yet"}; }
