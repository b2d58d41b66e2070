/** What there is to set at a site: the tabs above each of these pages. */
import { useTranslation } from "react-i18next";
import { NavLink } from "react-router-dom";
import type { Role } from "@/api/types";
import styles from "./settings.module.css";

export function SettingsTabs({ slug, role }: { slug: string; role: Role | undefined }) {
  const { t } = useTranslation();
  const tabs = [
    ["people", "people"],
    ["tokens", "tokens"],
    ...(role === "admin"
      ? ([
          ["storage", "retention"],
          ["review", "review"],
        ] as const)
      : []),
  ] as const;
  return (
    <nav aria-label={t("shell.nav.settings")}>
      <ul className={styles.tabs}>
        {tabs.map(([name, page]) => (
          <li key={name}>
            <NavLink to={`/sites/${slug}/${page}`}>{t(`people.tab.${name}`)}</NavLink>
          </li>
        ))}
      </ul>
    </nav>
  );
}
