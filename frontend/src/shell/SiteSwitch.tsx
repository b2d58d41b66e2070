import { Menu } from "@mantine/core";
import { Check, ChevronDown, Plus } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useMe } from "@/api/queries";
import type { Site } from "@/api/types";
import { initialsOf } from "@/design/Avatar";
import styles from "./sidebar.module.css";

function SiteSign({ site }: { site: Site }) {
  return (
    <span className={styles.sign} aria-hidden="true">
      {initialsOf(site.name)}
    </span>
  );
}

/** Which site, and how many of its devices are there. */
export function SiteSwitch({ site, sites }: { site: Site | undefined; sites: Site[] }) {
  const { t } = useTranslation();
  const mayAdd = useMe().data?.may_create_sites ?? false;
  if (!site) return null;
  const all = site.machines + site.robots;
  return (
    <Menu width={240} position="bottom-start">
      <Menu.Target>
        <button type="button" className={styles.switch}>
          <SiteSign site={site} />
          <span className={styles.switchText}>
            <strong>{site.name}</strong>
            <small>{t("shell.site.online", { online: site.online, all })}</small>
          </span>
          <span className="visually-hidden">{t("shell.site.choose")}</span>
          <ChevronDown size={15} aria-hidden="true" className={styles.wide} />
        </button>
      </Menu.Target>
      <Menu.Dropdown>
        {sites.map((each) => (
          <Menu.Item
            key={each.slug}
            component={Link}
            to={`/sites/${each.slug}/devices`}
            rightSection={each.slug === site.slug ? <Check size={15} /> : null}
          >
            {each.name}
          </Menu.Item>
        ))}
        {mayAdd ? (
          <>
            <Menu.Divider />
            <Menu.Item component={Link} to="/sites/new" leftSection={<Plus size={15} />}>
              {t("shell.site.add")}
            </Menu.Item>
          </>
        ) : null}
      </Menu.Dropdown>
    </Menu>
  );
}
