/** The pages of a site's settings, in the order of their tabs; the tab's word is `tab` in people.json, by `name`. */

interface SettingsPage {
  /** Names its tab. */
  name: string;
  /** Its address below the site. */
  path: string;
  /** Its file below `src`, which exports a component of that name. */
  file: string;
  isForAdmins?: true;
}

export const SETTINGS_PAGES: readonly SettingsPage[] = [
  { name: "people", path: "people", file: "pages/settings/PeoplePage" },
  { name: "tokens", path: "tokens", file: "pages/tokens/TokensPage" },
  { name: "storage", path: "retention", file: "pages/retention/RetentionPage", isForAdmins: true },
  { name: "review", path: "review", file: "pages/review/ReviewRulePage", isForAdmins: true },
];
