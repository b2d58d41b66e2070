/** The texts of a language: each file is one area, `t("area.key")`. */
export type Areas = Record<string, Record<string, unknown>>;

/** `{shell: …, run: …}` out of `./en/shell.json` and so on, of one language. */
export function gatherAreas(sources: Areas): Areas {
  const areas = Object.entries(sources).map(([path, texts]) => [/(\w+)\.json$/.exec(path)?.[1] ?? path, texts]);
  return Object.fromEntries(areas) as Areas;
}
