/** All German texts, loaded where the screens are German. */
export const texts = import.meta.glob<Record<string, unknown>>("./de/*.json", {
  eager: true,
  import: "default",
});
