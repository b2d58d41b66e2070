/** The screen on which an admin changes a site's map; others are told who can. */
import { Button, Skeleton } from "@mantine/core";
import { MapPinned } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite, useSiteMap } from "@/api/queries";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { MapEditor } from "./MapEditor";

export function MapEditPage() {
  const { t } = useTranslation();
  const { slug = "" } = useParams();
  const site = useSite(slug);
  const map = useSiteMap(site.data?.has_map ? slug : undefined);
  const problem = missing(site, map);
  if (site.data?.role === "admin" && map.data) return <MapEditor key={slug} site={site.data} newest={map.data} />;
  const isAdmin = site.data?.role === "admin";
  const isSettled = site.data && (!isAdmin || !site.data.has_map);
  return (
    <PageShell title={t("mapEdit.title")}>
      {problem ? <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), map.refetch()])} /> : null}
      {!problem && !isSettled ? <Skeleton height="100%" radius="lg" /> : null}
      {isSettled ? (
        <Panel>
          <EmptyState
            icon={<MapPinned size={20} />}
            title={t(isAdmin ? "pages.map.none" : "mapEdit.adminsOnly")}
            text={t(isAdmin ? "pages.map.noneText" : "mapEdit.askAdmin")}
          >
            <Button component={Link} to={`/sites/${slug}/map${isAdmin ? "/new" : ""}`} variant="default">
              {t(isAdmin ? "mapEdit.upload" : "shell.nav.map")}
            </Button>
          </EmptyState>
        </Panel>
      ) : null}
    </PageShell>
  );
}
