/** What there is to set at a site: the tabs above each of these pages. */
import { useTranslation } from "react-i18next";
import { NavLink } from "react-router-dom";
import type { Role } from "@/api/types";
import styles from "./settings.module.css";
import { SETTINGS_PAGES } from "./settingsPages";

export function SettingsTabs({ slug, role }: { slug: string; role: Role | undefined }) {
  const { t } = useTranslation();
  return (
    <nav aria-label={t("shell.nav.settings")}>
      <ul className={styles.tabs}>
        {SETTINGS_PAGES.filter((page) => role === "admin" || !page.isForAdmins).map(({ name, path }) => (
          <li key={name}>
            <NavLink to={`/sites/${slug}/${path}`}>{t(`people.tab.${name}`)}</NavLink>
          </li>
        ))}
      </ul>
    </nav>
  );
}
