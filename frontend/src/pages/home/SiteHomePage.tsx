/** A site's own address: Home, about that site; who does not see it is told. */
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate, useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite } from "@/api/queries";
import { keepSite } from "@/shell/currentSite";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";

export function SiteHomePage() {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const { slug = "" } = useParams();
  const site = useSite(slug);
  const isThere = site.data !== undefined;
  useEffect(() => {
    if (!isThere) return;
    keepSite(slug);
    void navigate("/", { replace: true });
  }, [isThere, slug, navigate]);
  const problem = missing(site);
  return (
    <PageShell title={t("shell.nav.home")}>
      {problem ? <LoadProblem error={problem} again={() => void site.refetch()} /> : null}
    </PageShell>
  );
}
