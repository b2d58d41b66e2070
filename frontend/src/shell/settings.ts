/** The handle of the routes that are pages of a site's settings. */
export const SETTINGS = "settings";
