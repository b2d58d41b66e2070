/** The invitations of a site: which let people in still, who came by them, and their end. */
import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { Plus } from "lucide-react";
import { useRef } from "react";
import { useTranslation } from "react-i18next";
import type { Invitation } from "@/api/types";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import { formatMoment } from "@/i18n/format";
import { tellRefusal } from "@/shell/refusal";
import pages from "../pages.module.css";
import { EndButton } from "./EndButton";
import { useRevoke } from "./people";
import { RoleChip } from "./RoleSelect";
import styles from "./settings.module.css";

const COLUMNS = ["role", "ends", "uses", "by", "act"];

interface RowProps {
  invitation: Invitation;
  revoke: () => void;
  busy: boolean;
  /** Who has the focus when it was revoked. */
  afterwards: () => HTMLElement | null;
}

function Row({ invitation, revoke, busy, afterwards }: RowProps) {
  const { t } = useTranslation();
  const { role, state, people, email, made_at } = invitation;
  const isOpen = state === "open";
  return (
    <tr data-over={!isOpen || undefined}>
      <td>
        <RoleChip role={role} />
      </td>
      <td className={pages.nowrap}>
        {isOpen ? formatMoment(invitation.expires_at) : t(`people.invitations.state.${state}`)}
      </td>
      <td>
        {t("people.invitations.of", { used: invitation.used, uses: invitation.uses })}
        {people.length > 0 ? (
          <small className={pages.reason}>{t("people.invitations.came", { names: people.join(", ") })}</small>
        ) : null}
        {email ? <small className={pages.reason}>{t("people.invitations.to", { email })}</small> : null}
      </td>
      <td className={pages.optional}>{invitation.mine ? t("people.invitations.you") : invitation.made_by || "–"}</td>
      <td>
        {isOpen ? (
          <EndButton
            label={t("people.invitations.revokeLabel", { role: t(`role.${role}`), when: formatMoment(made_at) })}
            words={t("people.invitations.revoke")}
            busy={busy}
            end={revoke}
            afterwards={afterwards}
          />
        ) : null}
      </td>
    </tr>
  );
}

interface Props {
  slug: string;
  invitations: Invitation[];
  onNew: () => void;
}

export function Invitations({ slug, invitations, onNew }: Props) {
  const { t } = useTranslation();
  const revoke = useRevoke(slug);
  const heading = useRef<HTMLHeadingElement>(null);
  /** Each answer is told, also where another invitation is ended meanwhile. */
  const end = (id: number) =>
    revoke.mutateAsync(id).then(
      () => notifications.show({ message: t("people.invitations.revoked") }),
      (error: Error) => tellRefusal(error, t),
    );
  return (
    <Panel className={styles.section} aria-label={t("people.invitations.title")}>
      <div className={styles.head}>
        <h2 ref={heading} tabIndex={-1}>
          {t("people.invitations.title")}
        </h2>
        <Chip>{invitations.filter((each) => each.state === "open").length}</Chip>
        <Button
          className={styles.last}
          size="xs"
          variant="default"
          leftSection={<Plus size={15} aria-hidden="true" />}
          onClick={onNew}
        >
          {t("people.invitations.new")}
        </Button>
      </div>
      {invitations.length === 0 ? (
        <p className={styles.none}>{t("people.invitations.none")}</p>
      ) : (
        <div className={pages.scroll}>
          <table className={pages.table}>
            <thead>
              <tr>
                {COLUMNS.map((column) => (
                  <th key={column} scope="col" className={column === "by" ? pages.optional : undefined}>
                    <span className={column === "act" ? "visually-hidden" : undefined}>
                      {t(`people.invitations.column.${column}`)}
                    </span>
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {invitations.map((each) => (
                <Row
                  key={each.id}
                  invitation={each}
                  revoke={() => void end(each.id)}
                  busy={revoke.isPending && revoke.variables === each.id}
                  afterwards={() => heading.current}
                />
              ))}
            </tbody>
          </table>
        </div>
      )}
    </Panel>
  );
}
