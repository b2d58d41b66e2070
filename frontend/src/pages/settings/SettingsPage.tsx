/** A page on which admins set something for their site: the tabs, what keeps it from being shown, and what there is. */
import type { ReactNode } from "react";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite } from "@/api/queries";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";
import { SettingsTabs } from "./SettingsTabs";
import { useSetting } from "./siteSetting";

interface SettingsPageProps<Held> {
  /** Where the site's API has the setting, below the site. */
  path: string;
  title: string;
  /** What others than admins are told. */
  notForYou: string;
  children: (held: Held, slug: string) => ReactNode;
}

export function SettingsPage<Held>(props: SettingsPageProps<Held>) {
  const { slug = "" } = useParams();
  return <SettingsOfSite<Held> key={slug} slug={slug} {...props} />;
}

function SettingsOfSite<Held>({ slug, path, title, notForYou, children }: SettingsPageProps<Held> & { slug: string }) {
  const site = useSite(slug);
  const isAdmin = site.data?.role === "admin";
  const setting = useSetting<Held>(slug, path, isAdmin);
  const problem = missing(site, setting);
  const isForOthers = site.data !== undefined && !isAdmin;
  return (
    <PageShell title={title}>
      <SettingsTabs slug={slug} role={site.data?.role} />
      <div className={pages.stack}>
        {problem ? (
          <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), setting.refetch()])} />
        ) : null}
        {isForOthers ? (
          <Panel>
            <EmptyState title={notForYou} />
          </Panel>
        ) : null}
        {!problem && !isForOthers && !setting.data ? <TableSkeleton /> : null}
        {isAdmin && setting.data ? children(setting.data, slug) : null}
      </div>
    </PageShell>
  );
}
