/** The English texts of the screens beside the editor, which does not wait for them. */
export const texts = import.meta.glob<Record<string, unknown>>("./en/screens/*.json", {
  eager: true,
  import: "default",
});
