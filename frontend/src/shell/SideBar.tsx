/** The side bar of the management pages: site, pages, account. */
import { Activity, History, LayoutGrid, Library, Map, Cpu, Settings, Workflow, type LucideIcon } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, NavLink, useMatches } from "react-router-dom";
import { usePrograms } from "@/api/queries";
import type { Role } from "@/api/types";
import { Chip } from "@/design/Chip";
import { Logo } from "@/design/Logo";
import { AccountBar } from "./AccountBar";
import { useCurrentSite } from "./currentSite";
import { seesOperations } from "./findings/findings";
import { PaletteButton } from "./palette/PaletteButton";
import { SETTINGS } from "./settings";
import { SiteSwitch } from "./SiteSwitch";
import styles from "./sidebar.module.css";

interface EntryProps {
  to: string;
  icon: LucideIcon;
  label: string;
  count?: number;
  news?: string;
  end?: boolean;
  /** It is marked, whatever the address says. */
  marked?: boolean;
}

function Entry({ to, icon: Icon, label, count, news, end, marked = false }: EntryProps) {
  return (
    <li>
      <NavLink
        to={to}
        end={end}
        className={({ isActive }) => `${styles.entry} ${isActive || marked ? "active" : ""}`}
        title={label}
      >
        <Icon size={18} strokeWidth={1.75} aria-hidden="true" />
        <span className={styles.word}>{label}</span>
        {count !== undefined ? <span className={styles.count}>{count}</span> : null}
        {news ? <Chip tone="pend">{news}</Chip> : null}
      </NavLink>
    </li>
  );
}

interface SiteEntriesProps {
  slug: string;
  /** The site, if it may be asked. */
  open: string | undefined;
  pending: number;
  role: Role | undefined;
}

function SiteEntries({ slug, open, pending, role }: SiteEntriesProps) {
  const { t } = useTranslation();
  const programs = usePrograms(open).data?.length;
  const at = (page: string) => `/sites/${slug}/${page}`;
  return (
    <>
      <Entry to={at("programs")} icon={Workflow} label={t("shell.nav.programs")} count={programs} />
      <Entry
        to={at("devices")}
        icon={Cpu}
        label={t("shell.nav.devices")}
        news={pending > 0 ? t("shell.nav.new", { count: pending }) : undefined}
      />
      <Entry to={at("library")} icon={Library} label={t("shell.nav.library")} />
      <Entry to={at("runs")} icon={History} label={t("shell.nav.runs")} />
      <Entry to={at("map")} icon={Map} label={t("shell.nav.map")} />
      {seesOperations(role) ? <Entry to={at("operations")} icon={Activity} label={t("shell.nav.operations")} /> : null}
    </>
  );
}

export function SideBar() {
  const { t } = useTranslation();
  const { slug, open, site, sites } = useCurrentSite();
  const inSettings = useMatches().some(({ handle }) => handle === SETTINGS);
  return (
    <aside className={styles.side}>
      <Link to="/" className={styles.brand} aria-label={t("shell.brandHome")}>
        <Logo size={26} />
        <span className={styles.word}>VIPO</span>
      </Link>
      <SiteSwitch site={site} sites={sites} />
      <PaletteButton slug={open} />
      <nav aria-label={t("shell.nav.pages")}>
        <ul className={styles.entries}>
          <Entry to="/" end icon={LayoutGrid} label={t("shell.nav.home")} />
          {slug ? <SiteEntries slug={slug} open={open} pending={site?.pending ?? 0} role={site?.role} /> : null}
        </ul>
      </nav>
      {slug ? (
        <ul className={styles.entries}>
          <Entry to={`/sites/${slug}/people`} icon={Settings} label={t("shell.nav.settings")} marked={inSettings} />
        </ul>
      ) : null}
      <AccountBar role={site?.role} slug={slug} />
    </aside>
  );
}
