/** The shapes that cross the border to the server, as docs/architecture.md names them. */

export type * from "./alerts";
export type * from "./devices";
export type * from "./maps";
export type * from "./programs";
export type * from "./questions";
export type * from "./rehearsals";
export type * from "./runs";
export type * from "./sites";
export type * from "./values";
