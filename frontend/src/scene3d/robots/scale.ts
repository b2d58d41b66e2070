/** Robots are drawn larger than they are, so that they are seen in a hall; the page says so. */
export const ROBOT_SCALE = 2;
