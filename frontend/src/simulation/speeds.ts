/** How many times as fast as it was a recording is played. */
export const SPEEDS = [0.25, 0.5, 1, 2, 5, 10, 20] as const;
