/** The bounds of what admins set for a site, as the API holds to them; a test compares both. */

/** Of approvals that a program needs. */
export const MOST_APPROVALS = 9;
/** Of days for which something is kept: a hundred years. */
export const MOST_DAYS = 36_500;
