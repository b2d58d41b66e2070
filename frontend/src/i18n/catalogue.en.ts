/** All English texts, loaded where the screens are English. */
export const texts = import.meta.glob<Record<string, unknown>>("./en/*.json", {
  eager: true,
  import: "default",
});
