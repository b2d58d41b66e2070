/** The people of a site: members, invitations, who may do what, and what was done; for others than admins oneself. */
import { Button } from "@mantine/core";
import { UserPlus } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite } from "@/api/queries";
import type { MadeInvitation } from "@/api/types";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";
import { useShownOnce } from "../useShownOnce";
import { AuditPane } from "./AuditPane";
import { FactorRule } from "./FactorRule";
import { Invitations } from "./Invitations";
import { MemberTable } from "./MemberTable";
import { LinkShown, NewInvitation } from "./NewInvitation";
import { useInvitations, useMembers, useRights } from "./people";
import { RightsTable } from "./RightsTable";
import { SettingsTabs } from "./SettingsTabs";
import styles from "./settings.module.css";
import { WallScreens } from "./WallScreens";

export function PeoplePage() {
  const { slug = "" } = useParams();
  return <PeopleOfSite key={slug} slug={slug} />;
}

/** The invitations, and the dialogs of a new one. */
function Inviting({ slug, making, setMaking }: { slug: string; making: boolean; setMaking: (is: boolean) => void }) {
  const invitations = useInvitations(slug);
  const links = useShownOnce<MadeInvitation>();
  if (invitations.isLoadingError)
    return <LoadProblem error={invitations.error} again={() => void invitations.refetch()} />;
  if (!invitations.data) return <TableSkeleton />;
  return (
    <>
      <Invitations slug={slug} invitations={invitations.data.invitations} onNew={() => setMaking(true)} />
      {making ? (
        <NewInvitation
          slug={slug}
          canMail={invitations.data.can_mail}
          onMade={links.show}
          onClose={() => setMaking(false)}
        />
      ) : null}
      {links.shown ? <LinkShown key={links.shown.link} made={links.shown} onClose={links.next} /> : null}
    </>
  );
}

function PeopleOfSite({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const site = useSite(slug);
  const members = useMembers(slug);
  const rights = useRights();
  const [making, setMaking] = useState(false);
  const manages = site.data?.role === "admin";
  const problem = missing(site, members, rights);
  const invite = (
    <Button leftSection={<UserPlus size={16} aria-hidden="true" />} onClick={() => setMaking(true)}>
      {t("people.invite")}
    </Button>
  );
  return (
    <PageShell title={t("shell.nav.people")} actions={manages ? invite : null}>
      <SettingsTabs slug={slug} role={site.data?.role} />
      <div className={manages ? styles.columns : undefined}>
        <div className={pages.stack}>
          {problem ? (
            <LoadProblem
              error={problem}
              again={() => void Promise.all([site.refetch(), members.refetch(), rights.refetch()])}
            />
          ) : null}
          {members.isPending ? <TableSkeleton /> : null}
          {members.data ? <MemberTable slug={slug} members={members.data} manages={manages} /> : null}
          {manages ? <Inviting slug={slug} making={making} setMaking={setMaking} /> : null}
          {manages ? <FactorRule slug={slug} /> : null}
          {manages ? <WallScreens slug={slug} /> : null}
          {rights.data ? <RightsTable deeds={rights.data} /> : null}
        </div>
        {manages ? <AuditPane slug={slug} /> : null}
      </div>
    </PageShell>
  );
}
