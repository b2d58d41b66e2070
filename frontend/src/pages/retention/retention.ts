/** For how many days a site keeps what has ended: where it is set, and the fields in which people choose it. */
import { MOST_DAYS } from "../settings/bounds";

/** Where the site's API has it. */
export const PATH = "retention";

/** Days as they were typed: null for an empty field, undefined for what is no whole number of days. */
export function readDays(typed: string): number | null | undefined {
  const text = typed.trim();
  if (text === "") return null;
  return /^\d{1,5}$/.test(text) && Number(text) <= MOST_DAYS ? Number(text) : undefined;
}
